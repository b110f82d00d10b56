#ifndef FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_BUS_H_
#define FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_BUS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/time.h"
#include "tests/sim/bus.h"
#include "tests/tools/firmware/firmware.h"

namespace facewire::firmware {

struct FirmwareBusOptions : sim::BusOptions {
  FirmwareBusOptions() { baud = 115'200; }
};

// The receiver as a simulated bus in virtual time (tests/sim/bus.h: Receive, Advance, Transmit,
// trace, faults): the firmware's own files, compiled for this machine, and a hobby servo at each of
// its twelve outputs. What avr/ does is done here: a tick every 20 ms whose pulses show in the next
// period, each at its own time in it. Positions are us of pulse width; 0 is no pulse.
//
// Beyond what all buses record: kWatchdog when the failsafe's hold is over (its time in ms),
// kDamagedPacket for each piece that the decoder dropped, kReboot for each start after the first.
class FirmwareBus final : public sim::Bus {
 public:
  explicit FirmwareBus(const FirmwareBusOptions& options);

  // What the last servo pulses that it obeyed asked for.
  double Goal(std::size_t index) const override { return receiver_.wish[index] / 4.0; }
  // The pulse at the output in this period, or the last.
  double Commanded(std::size_t index) const override { return outputs_[index].width / 2.0; }
  double ToOwn(double rad) const override;
  double ToRad(double own) const override;

  FwState state() const { return receiver_.state; }
  const FwReceiver& receiver() const { return receiver_; }
  const FwLinkStats& link() const { return decoder_.stats; }

  // The board starts anew: pulses end at once, and for so long it hears nothing (a boot loader's
  // time). By the reset pin or the watchdog it remembers where its servos were; when its power was
  // gone it does not.
  void Reset(Duration takes);
  void PowerCycle(Duration takes);

 private:
  struct Output {
    std::uint16_t width = 0;  // half microseconds
    bool pulsed = false;      // in this period
    unsigned missing = 0;     // periods without a pulse
  };

  void OnByte(std::uint8_t byte, sim::Nanos at) override;
  void OnMillisecond(Time at) override;
  void OnPowerUp(std::size_t) override {}  // a hobby servo remembers nothing
  void Start();
  void StartPeriod();
  void RunEdges(std::uint16_t until);
  void Tick(Time at);

  FwDecoder decoder_{};
  FwReceiver receiver_{};
  FwRetained retained_{};
  std::array<Output, FW_SERVOS> outputs_{};
  std::array<std::uint16_t, FW_SERVOS> planned_{};
  std::array<FwEdge, FW_MAX_EDGES> edges_{};
  std::size_t next_edge_ = 0;
  std::array<std::uint16_t, FW_SERVOS> rose_at_{};
  unsigned millisecond_ = 0;  // of the period
  std::uint8_t reset_causes_ = 1;
  Duration booting_{};
  sim::Nanos line_free_ = 0;
};

}  // namespace facewire::firmware

#endif  // FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_BUS_H_
