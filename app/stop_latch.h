#ifndef FACEWIRE_APP_STOP_LATCH_H_
#define FACEWIRE_APP_STOP_LATCH_H_

#include <string>
#include <vector>

#include "app/file_calls.h"

namespace facewire::app {

// Remembers an emergency stop over a crash, a restart and a loss of power. The memory is a file in
// the first of some folders that takes it; that it exists is all it says, so there is no half of
// it. Whatever exists, or cannot be looked at, counts as a stop: nothing but Release makes a rig
// move.
class StopLatch {
 public:
  // From the most to the least lasting; those that are empty are left out. `files` is borrowed.
  explicit StopLatch(const std::vector<std::string>& folders, FileCalls& files = LinuxFiles());

  // Whether a stop is remembered. `why_`: where, or why that cannot be told.
  bool Engaged() noexcept;
  // Remembers, on the disk before it answers. False: it could not, or not beyond a restart of the
  // machine; reason() says why.
  bool Engage() noexcept;
  // Forgets. False, and the stop stays: a file could not be removed; reason() says why.
  bool Release() noexcept;

  // Of the last call, one line for a person; "" when all is well.
  const std::string& reason() const noexcept { return reason_; }

 private:
  bool SyncFolder(const std::string& path) noexcept;
  bool Make(const std::string& path) noexcept;
  void Blame(const std::string& path, const char* what) noexcept;

  std::vector<std::string> paths_;
  FileCalls& files_;
  std::string reason_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_STOP_LATCH_H_
