#ifndef FACEWIRE_TOOLS_FACEWIRE_MONITOR_MODEL_H_
#define FACEWIRE_TOOLS_FACEWIRE_MONITOR_MODEL_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/inline_vector.h"
#include "core/wire/decoder.h"
#include "core/wire/rig_description.h"

namespace facewire::tools {

// Ages of poses when they were sent, in buckets of a millisecond; a second and more share the last.
class AgeHistogram {
 public:
  void Add(std::uint32_t age_us) noexcept;
  bool empty() const noexcept { return count_ == 0; }
  // The age in ms that `part` (0..1) of all poses do not exceed.
  int Quantile(double part) const noexcept;

 private:
  std::array<std::uint64_t, 1001> buckets_{};
  std::uint64_t count_ = 0;
};

// Frames a second of the camera behind the poses, from the last capture times: right for a
// recording that is read faster than it was made, and not fooled by poses that repeat a capture.
class CaptureRate {
 public:
  void Add(Time captured) noexcept;
  std::optional<double> fps() const noexcept;  // nullopt until two captures came

 private:
  std::array<Time, 32> times_{};
  std::size_t count_ = 0;
};

// All that is known of the line at one moment; filled by a MonitorSession, shown by monitor_view.h.
struct MonitorModel {
  std::string port;
  double elapsed_s = 0;  // since the port was opened
  std::uint64_t bytes = 0;
  wire::LinkStats link;
  wire::RigCollector rig;
  std::uint64_t poses = 0;
  std::optional<wire::Pose> pose;      // the last one
  std::optional<wire::Status> status;  // the last one
  std::optional<ServiceState> state;   // of whichever came last
  std::string note;                    // the device's last answer that was not "ok"
  CaptureRate rate;
  AgeHistogram ages;

  // The rig that the last pose was made for is known.
  bool RigKnown() const noexcept {
    return rig.Complete() && (!pose || pose->rig_id == rig.rig_id());
  }
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_MONITOR_MODEL_H_
