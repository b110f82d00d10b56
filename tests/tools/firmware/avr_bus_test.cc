// The flashed image and the firmware's files compiled for this machine, side by side on one line.
#include "tests/tools/firmware/avr_bus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tests/tools/firmware/firmware_bus.h"
#include "tests/tools/firmware/firmware_line.h"

namespace facewire::firmware {
namespace {

using std::chrono::milliseconds;

struct Context {
  Line line;
  FirmwareBus portable{FirmwareBusOptions()};
  AvrBus flashed{sim::BusOptions(), FW_SERVOS};
  Time now = Time(milliseconds(1000));
  double worst = 0;  // us between their pulses, where neither is moving

  Context() {
    Pass({});  // their lives begin
    Pass(milliseconds(100));
  }
  void Pass(Duration time) {
    now += time;
    portable.Advance(now);
    flashed.Advance(now);
  }
  void Send(const Bytes& bytes) {
    portable.Receive(bytes, now);
    flashed.Receive(bytes, now);
  }
  void Follow(const wire::ServoPulses& pulses, int periods) {
    for (; periods > 0; --periods) {
      Send(line.Send(pulses));
      Pass(milliseconds(20));
    }
  }
  void Compare() {
    for (std::size_t i = 0; i < FW_SERVOS; ++i) {
      worst = std::max(worst, std::abs(portable.Commanded(i) - flashed.Commanded(i)));
      EXPECT_EQ(portable.TorqueOn(i), flashed.TorqueOn(i)) << i;
    }
  }
};

TEST(AvrBus, ItsPulsesAreThoseOfTheFilesCompiledForThisMachine) {
  Context c;
  c.Compare();
  c.Send(c.line.Send(TwelveServos()));
  c.Pass(milliseconds(40));
  wire::ServoPulses pulses = AllAt(1500);
  for (std::size_t i = 0; i < FW_SERVOS; ++i) {
    pulses.quarter_us[i] = static_cast<std::uint16_t>(4 * (1200 + 50 * i) + i);
  }
  pulses.quarter_us[4] = 0;
  c.Follow(pulses, 100);
  c.Compare();
  EXPECT_LE(c.worst, 0.5);
  EXPECT_EQ(c.flashed.Commanded(4), 0);
  EXPECT_FALSE(c.flashed.TorqueOn(4));
  EXPECT_EQ(c.flashed.Goal(5), pulses.quarter_us[5] / 4.0);
  EXPECT_NEAR(c.flashed.Position(5), 1450, 15);

  // Its failsafe: at neutral after 200 + 400 ms, limp after 300 more.
  c.Pass(milliseconds(750));
  c.Compare();
  EXPECT_LE(c.worst, 0.5);
  EXPECT_NEAR(c.flashed.Commanded(5), 1500, 0.5);
  c.Pass(milliseconds(300));
  c.Compare();
  EXPECT_FALSE(c.flashed.TorqueOn(5));
}

TEST(AvrBus, AnswersAtItsLinesRate) {
  Context c;
  (void)c.flashed.Transmit();
  c.Pass(milliseconds(3000));
  wire::Decoder decoder;
  const auto bytes = c.flashed.Transmit();
  std::span<const std::byte> rest(bytes);
  int statuses = 0;
  while (const auto received = decoder.Next(rest)) {
    statuses += std::holds_alternative<wire::ReceiverStatus>(received->message) ? 1 : 0;
  }
  EXPECT_EQ(statuses, 3);
}

}  // namespace
}  // namespace facewire::firmware
