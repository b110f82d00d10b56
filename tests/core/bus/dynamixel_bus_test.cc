#include "core/bus/dynamixel_bus.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/bus/chain_context.h"
#include "tests/core/wire/hex.h"

namespace facewire::bus {
namespace {

using Context = ChainContext<DynamixelKind>;
using What = Written::What;

TEST(DynamixelBus, TheWatchdogIsSetBeforeTorqueComesOn) {
  Context c(1);
  c.RunUp();
  const auto torque = std::ranges::find_if(
      c.peer.written, [](const Written& w) { return w.what == What::kTorque && w.value == 1; });
  const auto watchdog = std::ranges::find_if(
      c.peer.written, [](const Written& w) { return w.what == What::kWatchdog && w.value == 25; });
  EXPECT_LT(watchdog, torque);
  EXPECT_EQ(c.servo(1).watchdog, 25);  // 500 ms
}

TEST(DynamixelBus, AStillFaceFeedsTheWatchdogManyTimesOver) {
  Context c(2);
  c.RunUp();
  Time fed = c.now;
  for (int i = 0; i < 1000; ++i) {
    c.Tick();
    if (c.last_bytes != 0) fed = c.now;
    ASSERT_LT(c.now - fed, milliseconds(150));
  }
}

TEST(DynamixelBus, AWatchdogThatTrippedIsClearedAndTheServoArmedAnew) {
  Context c(2);
  c.RunUp();
  c.servo(1).watchdog = 255;  // the line was cut for a while; goals cannot be written now
  c.peer.written.clear();
  c.Run(milliseconds(3000));
  EXPECT_EQ(c.servo(1).watchdog, 25);
  EXPECT_EQ(c.state(1), ServoState::kOn);
  EXPECT_EQ(c.bus.status().torque_lost, 1U);
  std::vector<std::pair<What, int>> order;
  for (const Written& w : c.peer.written) {
    if (w.id == 1 && (w.what == What::kTorque || w.what == What::kWatchdog)) {
      order.emplace_back(w.what, w.value);
    }
  }
  using Order = std::vector<std::pair<What, int>>;
  EXPECT_EQ(
      order,
      (Order{{What::kTorque, 0}, {What::kWatchdog, 0}, {What::kWatchdog, 25}, {What::kTorque, 1}}));
}

TEST(DynamixelBus, AProfileInMillisecondsIsRefused) {
  Context c(1);
  c.peer.drive_mode = 4;
  c.Run(milliseconds(500));
  EXPECT_EQ(c.state(1), ServoState::kRefused);
  ASSERT_EQ(c.bus.status().findings.size(), 1U);
  EXPECT_EQ(c.bus.status().findings[0].setting, Setting::kProfileUnit);
}

TEST(DynamixelBus, WhatTheServoDoesNotSwitchOffAtIsTold) {
  Context c(1);
  c.config.shutdown |= Bit(HardwareFault::kEncoder);
  c.config.max_return_delay = std::chrono::microseconds(100);
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.Run(milliseconds(500));
  ASSERT_EQ(c.bus.status().findings.size(), 2U);
  EXPECT_EQ(c.bus.status().findings[0].setting, Setting::kReturnDelay);
  EXPECT_EQ(c.bus.status().findings[0].found, 500);
  EXPECT_EQ(c.bus.status().findings[1].setting, Setting::kShutdown);
  EXPECT_EQ(c.state(1), ServoState::kLimp);
}

TEST(DynamixelBus, LoadIsAPartOfWhatTheServoCanDo) {
  Context c(1);
  c.servo(1).load = -250 & 0xFFFF;
  c.Run(milliseconds(500));
  EXPECT_NEAR(*c.feedback(1).load, -0.25, 1e-6);
  EXPECT_NEAR(*c.feedback(1).voltage_v, 11.1, 1e-5);
}

TEST(DynamixelBus, TheWatchdogHasToBeLongerThanTheRefresh) {
  Context c(1);
  for (const auto& [time, fine] : {std::pair(milliseconds(299), false),
                                   {milliseconds(300), true},
                                   {milliseconds(2540), true},
                                   {milliseconds(2560), false}}) {
    c.config.watchdog = time;
    EXPECT_EQ(c.bus.Configure(c.config).has_value(), fine) << time.count();
  }
}

TEST(DynamixelBus, SettingsAreWrittenByAnOperatorsCommandAlone) {
  std::array<std::byte, 32> out{};
  const auto make = [&](Setting setting, int value) {
    const auto packet = DynamixelBus::MakeSetting(1, setting, value, out);
    return packet ? wire::Hex(packet->subspan(7, packet->size() - 9)) : Name(packet.error());
  };
  EXPECT_EQ(make(Setting::kMinPosition, 1000), "03 34 00 E8 03 00 00");
  EXPECT_EQ(make(Setting::kMaxPosition, 3000), "03 30 00 B8 0B 00 00");
  EXPECT_EQ(make(Setting::kOperatingMode, 3), "03 0B 00 03");
  EXPECT_EQ(make(Setting::kReturnDelay, 100), "03 09 00 32");
  EXPECT_EQ(make(Setting::kShutdown, Bit(HardwareFault::kHeat) | Bit(HardwareFault::kOverload)),
            "03 3F 00 24");
  EXPECT_EQ(make(Setting::kMaxPosition, 4096), "out of range");
  EXPECT_EQ(make(Setting::kMinPosition, -1), "out of range");
  EXPECT_EQ(make(Setting::kLock, 1), "unsupported");
}

}  // namespace
}  // namespace facewire::bus
