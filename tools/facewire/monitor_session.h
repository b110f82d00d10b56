#ifndef FACEWIRE_TOOLS_FACEWIRE_MONITOR_SESSION_H_
#define FACEWIRE_TOOLS_FACEWIRE_MONITOR_SESSION_H_

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "hal/clock.h"
#include "hal/serial_port.h"
#include "tools/facewire/monitor_model.h"
#include "tools/facewire/monitor_recorder.h"
#include "tools/facewire/monitor_view.h"
#include "tools/facewire/other_protocol.h"
#include "tools/facewire/rig_question.h"

namespace facewire::tools {

// Where the session shows itself.
struct MonitorDisplay {
  enum class Kind {
    kNone,    // the caller prints the summary, nothing else is shown
    kPlain,   // a line a second
    kScreen,  // a terminal that is redrawn in place
  };
  Kind kind = Kind::kNone;
  ScreenStyle style;
  std::function<ScreenSize()> size;  // asked before each redraw; kScreen only
  std::function<void(std::string_view)> write;
};

struct MonitorLimits {
  std::optional<double> seconds;        // ends after so long
  std::optional<std::uint64_t> frames;  // ends after so many poses
  bool may_write = true;                // false: never asks the device for anything
};

enum class MonitorEnd { kInterrupted, kTime, kFrames, kEndOfFile, kClosed };

// Listens to an open port until something ends it. While the rig is unknown it asks for the
// description once a second.
class MonitorSession {
 public:
  // Everything is borrowed; `recorder` may be null.
  MonitorSession(std::string port_name, hal::SerialPort& port, hal::Clock& clock,
                 MonitorDisplay display, MonitorRecorder* recorder);

  // Returns when a limit is reached, `stop` (asked 50 times a second) says so, the file ends or the
  // line closes. Throws Failure when reading fails in another way.
  MonitorEnd Run(const MonitorLimits& limits, const std::function<bool()>& stop);

  const MonitorModel& model() const noexcept { return model_; }

 private:
  // True when the limit of poses is reached.
  bool Take(std::span<const std::byte> bytes, std::optional<std::uint64_t> max_poses);
  void Use(const wire::Message& message);
  void Show(Time now);

  hal::SerialPort& port_;
  hal::Clock& clock_;
  MonitorDisplay display_;
  MonitorRecorder* recorder_;
  MonitorModel model_;
  wire::Decoder decoder_;
  RigQuestion question_;
  OscSpotter osc_;
  Time next_show_{};
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_MONITOR_SESSION_H_
