#ifndef FACEWIRE_HAL_LOCAL_LOCAL_LISTENER_H_
#define FACEWIRE_HAL_LOCAL_LOCAL_LISTENER_H_

#include <sys/types.h>

#include <string>

#include "core/base/result.h"
#include "hal/posix/unique_fd.h"

namespace facewire::hal::local {

// Listens at a socket's file that its owner and its group may use (mode 0660), and removes the file
// at the end.
class LocalListener {
 public:
  LocalListener() noexcept = default;
  LocalListener(const LocalListener&) = delete;
  LocalListener& operator=(const LocalListener&) = delete;
  ~LocalListener() { Close(); }

  // A file that a program left which no longer runs is replaced. kBusy: somebody listens there.
  // kUnsupported: something else than a socket is there, and stays. kNotFound: the folder does not
  // exist. kInvalidArgument (path empty or too long), kPermission, kIo.
  Result<> Open(const std::string& path);
  // The next client that waits, as a socket that never waits. kNotReady: none; kDisconnected: not
  // open; kIo. Allocates nothing.
  Result<posix::UniqueFd> Accept() noexcept;
  void Close() noexcept;

  bool is_open() const noexcept { return static_cast<bool>(fd_); }

 private:
  std::string path_;
  posix::UniqueFd fd_;
  dev_t device_ = 0;  // of the file that was made, which another program may have replaced since
  ino_t inode_ = 0;
};

}  // namespace facewire::hal::local

#endif  // FACEWIRE_HAL_LOCAL_LOCAL_LISTENER_H_
