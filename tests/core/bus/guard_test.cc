#include "core/bus/guard.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

namespace facewire::bus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Measured ten times a second; warm at 55, hot at 65, cool at 50 degrees; load from 0.6 to 0.9.
struct Context {
  Guard guard{GuardConfig{}};
  Time now;
  void Measure(float temperature_c, float load, Duration time = milliseconds(100),
               HardwareFaults faults = 0) {
    for (const Time end = now + time; now < end;) {
      now += milliseconds(100);
      guard.Update(now, temperature_c, load, faults);
    }
  }
};

TEST(Guard, ACoolServoAtEaseMayDoAll) {
  Context c;
  EXPECT_EQ(c.guard.factor(), 1);
  c.Measure(54.9F, 0.5F, seconds(100));
  EXPECT_EQ(c.guard.factor(), 1);
  EXPECT_EQ(c.guard.reason(), Reason::kNone);
}

TEST(Guard, HeatSlowsDownMoreAndMoreAndThenLetsGo) {
  Context c;
  c.Measure(57.5F, 0);
  EXPECT_NEAR(c.guard.factor(), 0.75, 1e-5);
  EXPECT_EQ(c.guard.reason(), Reason::kHeat);
  c.Measure(64.9F, 0);
  EXPECT_NEAR(c.guard.factor(), 0.2, 1e-5);
  c.Measure(65, 0);
  EXPECT_EQ(c.guard.factor(), 0);
  c.Measure(51, 0, seconds(60));
  EXPECT_EQ(c.guard.factor(), 0);
  c.Measure(50, 0);
  EXPECT_EQ(c.guard.factor(), 1);
}

TEST(Guard, AServoThatIsLetGoRestsEvenIfItIsCoolAtOnce) {
  Context c;
  c.Measure(70, 0);
  c.Measure(20, 0, milliseconds(4900));
  EXPECT_EQ(c.guard.factor(), 0);
  c.Measure(20, 0, milliseconds(200));
  EXPECT_EQ(c.guard.factor(), 1);
}

TEST(Guard, AMomentOfFullLoadIsNoHarmAndLastingLoadIs) {
  Context c;
  c.Measure(30, -1, milliseconds(2000));
  EXPECT_EQ(c.guard.factor(), 1);
  c.Measure(30, -1, milliseconds(3000));
  EXPECT_LT(c.guard.factor(), 1);
  EXPECT_GT(c.guard.factor(), 0);
  EXPECT_EQ(c.guard.reason(), Reason::kLoad);
  c.Measure(30, 1, milliseconds(5000));
  EXPECT_EQ(c.guard.factor(), 0);
  EXPECT_EQ(c.guard.reason(), Reason::kLoad);
  c.Measure(30, 0, milliseconds(6000));
  EXPECT_EQ(c.guard.factor(), 1);
}

TEST(Guard, FaultsLetGoAndVoltageAloneDoesNot) {
  Context c;
  c.Measure(30, 0, milliseconds(100), Bit(HardwareFault::kVoltage));
  EXPECT_EQ(c.guard.factor(), 1);
  c.Measure(30, 0, milliseconds(100), Bit(HardwareFault::kEncoder));
  EXPECT_EQ(c.guard.factor(), 0);
  EXPECT_EQ(c.guard.reason(), Reason::kHardware);
  c.Measure(30, 0, milliseconds(5100));
  EXPECT_EQ(c.guard.factor(), 1);
}

TEST(Guard, WhatIsNotMeasuredOrNoNumberChangesNothing) {
  Context c;
  c.Measure(60, 0.7F, seconds(30));
  const float factor = c.guard.factor();
  EXPECT_LT(factor, 1);
  for (int i = 0; i < 100; ++i) {
    c.now += milliseconds(100);
    c.guard.Update(c.now, std::nullopt, std::nullopt, 0);
    c.guard.Update(c.now, std::nanf(""), std::numeric_limits<float>::infinity(), 0);
  }
  EXPECT_EQ(c.guard.factor(), factor);
}

TEST(Guard, TheFactorIsAlwaysNoneOrFromAFifthToOne) {
  std::mt19937 random(3);
  Context c;
  for (int i = 0; i < 100'000; ++i) {
    c.now += milliseconds(random() % 3000);
    if (random() % 100 == 0) c.now -= seconds(10);
    c.guard.Update(c.now, static_cast<float>(random() % 200) - 50,
                   static_cast<float>(random() % 400) / 100 - 2,
                   static_cast<HardwareFaults>(random() % 20 == 0 ? random() : 0));
    const float factor = c.guard.factor();
    ASSERT_TRUE(factor == 0 || (factor >= 0.2F && factor <= 1)) << factor;
    ASSERT_EQ(factor == 1, c.guard.reason() == Reason::kNone);
  }
}

}  // namespace
}  // namespace facewire::bus
