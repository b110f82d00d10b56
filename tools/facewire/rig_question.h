#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_QUESTION_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_QUESTION_H_

#include <array>
#include <chrono>
#include <cstdint>

#include "core/base/time.h"
#include "core/wire/encoder.h"
#include "hal/serial_port.h"

namespace facewire::tools {

// Asks the device at the other end to describe its rig, once a second for as long as somebody wants
// to know.
class RigQuestion {
 public:
  void AskIfDue(Time now, hal::SerialPort& port) {
    using std::chrono::milliseconds;
    if (now < next_) return;
    next_ = now + milliseconds(1000);
    std::array<std::byte, wire::kCommandFrameBytes> buffer;
    const auto frame = encoder_.Encode(
        wire::Command{.id = ++id_, .code = wire::CommandCode::kDescribeRig}, buffer);
    // Whether it got through shows in the answer, and it is asked again. A line that cannot be
    // written to can still be read.
    if (frame) (void)port.Write(*frame, milliseconds(20));
  }

 private:
  wire::Encoder encoder_;
  std::uint16_t id_ = 0;
  Time next_{};
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_QUESTION_H_
