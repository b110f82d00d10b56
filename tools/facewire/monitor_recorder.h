#ifndef FACEWIRE_TOOLS_FACEWIRE_MONITOR_RECORDER_H_
#define FACEWIRE_TOOLS_FACEWIRE_MONITOR_RECORDER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/wire/message.h"
#include "core/wire/rig_description.h"
#include "tools/facewire/output_file.h"

namespace facewire::tools {

// Writes decoded poses to a file that appears when the session ends, whole or not at all.
//   CSV:   frame,t_us,age_us,state,CHANNEL,...
//   JSONL: {"frame":7,"t_us":123,"age_us":31000,"state":"tracking","values":{"jawOpen":0.31,...}}
// Poses that come before their rig is known wait for its description.
class MonitorRecorder {
 public:
  enum class Form { kCsv, kJsonl };

  // Throws BadInput when the path cannot be written to.
  MonitorRecorder(const std::string& path, Form form) : file_(path), path_(path), form_(form) {}

  // Call with every pose, and with the rig as far as it is known then.
  void Add(const wire::Pose& pose, const wire::RigCollector& rig);
  // Writes what waits, and makes the file appear. Throws Failure when no rig description came, so
  // that nothing could be written.
  void Finish(const wire::RigCollector& rig);

  std::uint64_t recorded() const noexcept { return recorded_; }
  std::uint64_t of_other_rigs() const noexcept { return of_other_rigs_; }

 private:
  void WriteWaiting(const wire::RigCollector& rig);
  void WriteHeader();
  void WritePose(const wire::Pose& pose);

  OutputFile file_;
  std::string path_;
  Form form_;
  std::vector<wire::Pose> waiting_;
  bool has_rig_ = false;
  std::uint32_t rig_id_ = 0;
  Rig rig_;
  std::uint64_t recorded_ = 0;
  std::uint64_t of_other_rigs_ = 0;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_MONITOR_RECORDER_H_
