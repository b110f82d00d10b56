// What a still face costs and what a moving one loses, for every setting of Following. The wishes
// are a tracker's: 30 frames a second that arrive unevenly, with white noise and a slow drift.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "core/servo/motion.h"
#include "tests/core/servo/generated_servos.h"

namespace facewire::servo {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kTick = milliseconds(10);
constexpr Duration kFrame = microseconds(33'333);

struct Noise {
  double white = 0.003;  // standard deviation, part of the servo's range
  double drift = 0.003;  // amplitude, over a dozen seconds
};

using Signal = double (*)(double t_s);  // part of the range

double Still(double /*t_s*/) { return 0.5; }
// Of a face that talks, nods and blinks: slow, fast, and with jumps of 60 ms.
double Moving(double t_s) {
  const double talk = 0.12 * std::sin(2 * std::numbers::pi * 2.3 * t_s) *
                      std::max(0.0, std::sin(2 * std::numbers::pi * 0.23 * t_s));
  const double nod = 0.15 * std::sin(2 * std::numbers::pi * 0.4 * t_s);
  const double phase = std::fmod(t_s, 3.7);
  const double blink = 0.2 * std::clamp(std::min(phase, 0.3 - phase) / 0.06, 0.0, 1.0);
  return 0.5 + talk + nod + blink;
}

struct Trace {
  std::vector<double> clean;     // what the signal is at each tick, in the servo's unit
  std::vector<double> commands;  // of each tick
  double changes_per_s = 0;
};

Trace Drive(const Servo& servo, const Actuator& actuator, const Following& following, Signal signal,
            const Noise& noise, unsigned seed) {
  ServoRig rig;
  (void)rig.servos.try_push(servo);
  rig.following = following;
  const auto motion = std::make_unique<Motion>();
  EXPECT_TRUE(motion->Configure(rig, std::vector<Actuator>{actuator}));
  std::mt19937 random(seed);
  std::normal_distribution<double> white(0, noise.white);
  std::uniform_real_distribution<double> late(0, 0.012);
  const double range = double{servo.max} - servo.min;
  const double phase = seed;
  Trace trace;
  Time frame(seconds(1));
  Time arrives = frame;
  std::size_t changes = 0;
  const auto settled = Time(seconds(13));
  for (Time now(seconds(1)); now < settled + seconds(60); now += kTick) {
    if (now >= arrives) {
      const double t = std::chrono::duration<double>(frame.time_since_epoch()).count();
      const double drift = noise.drift * std::sin(t / 2 + phase) * std::sin(t / 3.1);
      Wishes wish{.captured = frame, .count = 1};
      wish.positions[0] =
          static_cast<float>(servo.min + range * (signal(t) + drift + white(random)));
      motion->Take(wish, now);
      frame += kFrame;
      arrives = frame + microseconds(static_cast<int>(1e6 * late(random)));
    }
    motion->SetReading(0, servo.neutral, now);
    const Command& command = motion->Tick(now).servos[0];
    if (now < settled) continue;
    const double t = std::chrono::duration<double>(now.time_since_epoch()).count();
    trace.clean.push_back(servo.min + range * signal(t));
    trace.commands.push_back(command.position);
    changes += command.changed ? 1 : 0;
  }
  trace.changes_per_s = static_cast<double>(changes) / 60;
  return trace;
}

// How the commands differ from the signal `lag` ticks earlier: root of the mean square.
double Difference(const Trace& trace, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = lag; i < trace.clean.size(); ++i) {
    const double d = trace.commands[i] - trace.clean[i - lag];
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(trace.clean.size() - lag));
}

struct Quality {
  double lag_ms = 0;  // where commands and signal are most alike
  double off = 0;     // and how much they differ there, part of the range
};
Quality QualityOf(const Trace& trace, double range) {
  std::size_t best = 0;
  for (std::size_t lag = 0; lag < 30; ++lag) {
    if (Difference(trace, lag) < Difference(trace, best)) best = lag;
  }
  // Between the ticks: the parabola through the three squares around the best.
  double part = 0;
  if (best > 0) {
    const double a = std::pow(Difference(trace, best - 1), 2);
    const double b = std::pow(Difference(trace, best), 2);
    const double c = std::pow(Difference(trace, best + 1), 2);
    part = (a - c) / (2 * (a - 2 * b + c));
  }
  return {(static_cast<double>(best) + part) * 10, Difference(trace, best) / range};
}

TEST(StillFace, GivesASilentServoWithTheUsualSettings) {
  Servo pulses = PulseServo("jaw", 0);
  pulses.dead_band = 5;  // 0.5 % of its range, as the rig file's default
  Servo counts = CountServo("neck", 0);
  counts.dead_band = 10;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const double white : {0.002, 0.003, 0.005}) {
      for (const double drift : {0.0, 0.002, 0.005}) {
        const Noise noise{white, drift};
        const Trace a = Drive(pulses, kPulse, {}, Still, noise, seed);
        const Trace b = Drive(counts, kCounts, {}, Still, noise, seed);
        EXPECT_LT(a.changes_per_s, 1) << "pulses " << white << ' ' << drift << ' ' << seed;
        EXPECT_LT(b.changes_per_s, 1) << white << ' ' << drift << ' ' << seed;
      }
    }
  }
}

TEST(StillFace, StaysOffByNoMoreThanTheDeadBandAndWhatIsLeftOfTheNoise) {
  Servo servo = PulseServo("jaw", 0);
  servo.dead_band = 5;
  const Trace trace = Drive(servo, kPulse, {}, Still, {0.003, 0}, 3);
  for (const double command : trace.commands) ASSERT_NEAR(command, 1500, 5 + 3);
}

// Lag is counted from the camera's frame, of which the wishes here come 0 to 12 ms late, and has
// the servo's own acceleration in it.
TEST(MovingFace, LagAndNoiseOfEverySetting) {
  std::printf("calm  lead   still: changes/s   moving: lag   off by\n");
  Servo servo = PulseServo("jaw", 0);
  servo.dead_band = 5;
  for (const float calm : {0.F, 1.F, 2.F, 3.F, 5.F, 8.F}) {
    double lag_without_lead_ms = 0;
    for (const int lead_ms : {0, 15, 33}) {
      const Following following{calm, milliseconds(lead_ms)};
      const Trace still = Drive(servo, kPulse, following, Still, {}, 1);
      const Quality moving = QualityOf(Drive(servo, kPulse, following, Moving, {}, 1), 1000);
      std::printf("%4.0f %3d ms %18.2f %10.0f ms %7.2f %%\n", calm, lead_ms, still.changes_per_s,
                  moving.lag_ms, 100 * moving.off);
      EXPECT_LT(still.changes_per_s, calm >= 3 ? 0.2 : 60);
      if (lead_ms == 0) {
        EXPECT_LT(moving.lag_ms, 65 + 2 * calm);
        EXPECT_LT(moving.off, 0.018);
        lag_without_lead_ms = moving.lag_ms;
      } else {
        EXPECT_LT(moving.lag_ms, lag_without_lead_ms - 0.2 * lead_ms);
        EXPECT_LT(moving.off, 0.03);
      }
    }
  }
}

}  // namespace
}  // namespace facewire::servo
