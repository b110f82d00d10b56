#include "core/bus/feetech_bus.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/bus/chain_context.h"
#include "tests/core/wire/hex.h"

namespace facewire::bus {
namespace {

using Context = ChainContext<FeetechKind>;
using What = Written::What;

TEST(FeetechBus, SpeedIsNeverZeroBecauseThatMayMeanFull) {
  for (const int phase : {0, 4}) {
    Context c(2);
    c.peer.phase = phase;
    c.config.bus.servos[0].arrive_speed_per_s = 1;
    ASSERT_TRUE(c.bus.Configure(c.config));
    c.Run(milliseconds(500));
    c.StartAll();
    c.Run(milliseconds(1500));
    for (const Written& w : c.peer.written) {
      if (w.what == What::kSpeed) {
        ASSERT_GT(w.value, 0);
      }
    }
  }
}

TEST(FeetechBus, CoarseSpeedsAreCountedInFifties) {
  Context c(1);
  c.peer.phase = 0;
  c.RunUp();
  EXPECT_EQ(c.servo(1).speed, 4000);  // more than it can, in either unit
  const auto slow = std::ranges::find_if(
      c.peer.written, [](const Written& w) { return w.what == What::kSpeed && w.value == 8; });
  EXPECT_NE(slow, c.peer.written.end());  // 400 counts/s
}

TEST(FeetechBus, ScsServosAreSpokenToHighByteFirst) {
  Context c(2);
  c.peer.scs = true;
  c.config.series = FeetechSeries::kScs;
  c.config.sync_read = false;
  for (int i = 0; i < 2; ++i) {
    c.config.bus.servos[static_cast<std::size_t>(i)].min = 200;
    c.config.bus.servos[static_cast<std::size_t>(i)].max = 800;
  }
  for (auto& [id, servo] : c.peer.servos) {
    servo.min = 200;
    servo.max = 800;
    servo.position = 500;
  }
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.RunUp();
  EXPECT_TRUE(c.bus.status().findings.empty());
  c.Command(1, 301);
  c.Tick();
  EXPECT_EQ(c.servo(1).goal, 301);
  for (const Bytes& packet : c.peer.packets) EXPECT_NE(packet[4], std::byte{0x82});
}

TEST(FeetechBus, AServoThatTurnsWithoutEndIsRefused) {
  Context c(1);
  c.servo(1).min = c.servo(1).max = 0;
  c.Run(milliseconds(500));
  EXPECT_EQ(c.state(1), ServoState::kRefused);
}

TEST(FeetechBus, AnOpenLockAndAnotherRateAreTold) {
  Context c(1);
  c.servo(1).lock = 0;
  c.config.bus.baud = 115'200;
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.Run(milliseconds(1000));
  ASSERT_EQ(c.bus.status().findings.size(), 2U);
  EXPECT_EQ(c.bus.status().findings[0].setting, Setting::kBaudRate);
  EXPECT_EQ(c.bus.status().findings[0].wanted, 4);
  EXPECT_EQ(c.bus.status().findings[1].setting, Setting::kLock);
  EXPECT_EQ(c.state(1), ServoState::kLimp);
}

TEST(FeetechBus, LoadHasItsSignInBitTen) {
  Context c(1);
  c.servo(1).load = 0x400 | 250;
  c.Run(milliseconds(500));
  EXPECT_NEAR(*c.feedback(1).load, -0.25, 1e-6);
  EXPECT_NEAR(*c.feedback(1).voltage_v, 7.4, 1e-5);
}

TEST(FeetechBus, MoreThan31GoalsGoInSeveralPackets) {
  Context c(40);
  c.Run(milliseconds(3000));
  c.StartAll();
  c.Run(milliseconds(6000));
  for (int id = 1; id <= 40; ++id) c.Command(id, static_cast<float>(2200 + id));
  c.peer.packets.clear();
  while (c.Tick().empty()) {
  }
  EXPECT_EQ(
      std::ranges::count_if(c.peer.packets, [](const Bytes& p) { return p[4] == std::byte{0x83}; }),
      2);
  for (int id = 1; id <= 40; ++id) EXPECT_EQ(c.servo(id).goal, 2200 + id);
}

TEST(FeetechBus, SettingsAreWrittenByAnOperatorsCommandAlone) {
  std::array<std::byte, 64> out{};
  const auto packets =
      FeetechBus::MakeSetting(FeetechSeries::kSts, 1, Setting::kMaxPosition, 3000, out).value();
  EXPECT_EQ(wire::Hex(packets.unlock), "FF FF 01 04 03 37 00 C0");
  EXPECT_EQ(wire::Hex(packets.write), "FF FF 01 05 03 0B B8 0B 28");
  EXPECT_EQ(wire::Hex(packets.lock), "FF FF 01 04 03 37 01 BF");
  const auto scs =
      FeetechBus::MakeSetting(FeetechSeries::kScs, 1, Setting::kMaxPosition, 800, out).value();
  EXPECT_EQ(wire::Hex(scs.unlock), "FF FF 01 04 03 30 00 C7");
  EXPECT_EQ(wire::Hex(scs.write), "FF FF 01 05 03 0B 03 20 C8");
  const auto error = [&](FeetechSeries series, Setting setting, int value, std::size_t room) {
    return FeetechBus::MakeSetting(series, 1, setting, value, std::span(out).first(room)).error();
  };
  EXPECT_EQ(error(FeetechSeries::kScs, Setting::kMaxPosition, 1024, 64), Errc::kOutOfRange);
  EXPECT_EQ(error(FeetechSeries::kScs, Setting::kOperatingMode, 0, 64), Errc::kUnsupported);
  EXPECT_EQ(error(FeetechSeries::kSts, Setting::kLock, 0, 64), Errc::kUnsupported);
  EXPECT_EQ(error(FeetechSeries::kSts, Setting::kOperatingMode, 0, 20), Errc::kFull);
}

}  // namespace
}  // namespace facewire::bus
