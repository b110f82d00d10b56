// The firmware as it is flashed, on a simulated ATmega328P: what its pins do, to a cycle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "tests/tools/firmware/firmware_line.h"
#include "tests/tools/firmware/simulated_board.h"

namespace facewire::firmware {
namespace {

constexpr std::size_t kServos = SimulatedBoard::kServos;
constexpr double kPeriodMs = 20;

struct Context {
  Line line;
  SimulatedBoard board;
  std::vector<wire::ReceiverStatus> status;

  // Pulses every 20 ms, for so long.
  void Follow(const wire::ServoPulses& pulses, double ms) {
    for (double t = 0; t < ms; t += kPeriodMs) {
      board.Send(line.Send(pulses));
      board.RunFor(kPeriodMs);
    }
  }
  void Start(int us) {
    board.RunFor(40);
    board.Send(line.Send(TwelveServos()));
    Follow(AllAt(us), 1600);
    ASSERT_EQ(State(), wire::ReceiverState::kFollowing);
    Forget();
  }
  void Forget() {
    for (std::size_t i = 0; i < kServos; ++i) (void)board.TakePulses(i);
  }
  wire::ReceiverState State() {
    for (const auto& s : board.TakeStatus()) status.push_back(s);
    return status.empty() ? wire::ReceiverState::kWaiting : status.back().state;
  }
};

TEST(Firmware, IsSilentAtItsPinsAndSaysThatItWaitsUntilItHasASetup) {
  Context context;
  context.board.RunFor(100);
  context.Follow(AllAt(1500), 500);
  for (std::size_t i = 0; i < kServos; ++i) EXPECT_TRUE(context.board.TakePulses(i).empty());
  EXPECT_FALSE(context.board.AnyServoHigh());
  EXPECT_EQ(context.State(), wire::ReceiverState::kWaiting);
  EXPECT_EQ(context.status.front().capacity, kServos);
  EXPECT_GT(context.status.back().refused, 10U);
  EXPECT_NEAR(context.status.back().supply_mv, 5000, 60);
  EXPECT_EQ(context.board.received().Damaged(), 0U);
}

// Twelve different widths for a second with the line busy in both directions.
TEST(Firmware, PulsesAreExactToHalfAMicrosecondAndComeEvery20Ms) {
  Context context;
  context.Start(1500);
  wire::ServoPulses pulses = AllAt(0);
  for (std::size_t i = 0; i < kServos; ++i) {
    pulses.quarter_us[i] = static_cast<std::uint16_t>(4 * (1000 + 90 * static_cast<int>(i)));
  }
  context.Follow(pulses, 400);
  context.Forget();
  for (int i = 0; i < 200; ++i) {
    context.board.Send(context.line.Send(pulses));
    context.board.RunFor(5);
  }
  double widest = 0;
  for (std::size_t i = 0; i < kServos; ++i) {
    const auto seen = context.board.TakePulses(i);
    ASSERT_GE(seen.size(), 49U) << i;
    const double wish = pulses.quarter_us[i] / 4.0;
    for (std::size_t p = 0; p < seen.size(); ++p) {
      widest = std::max(widest, std::abs(seen[p].width_us - wish));
      if (p > 0) {
        EXPECT_NEAR(seen[p].start_us - seen[p - 1].start_us, 20'000, 1) << i;
      }
    }
  }
  EXPECT_LE(widest, 0.5);
  RecordProperty("worst_width_error_ns", static_cast<int>(widest * 1000));
  std::printf("worst width error %.3f us\n", widest);
}

// Every servo sweeps, so that edges of different pulses meet in every way.
TEST(Firmware, PulsesThatMeetDoNotDisturbEachOther) {
  Context context;
  context.Start(1500);
  double worst = 0;
  for (int step = 0; step < 50; ++step) {
    wire::ServoPulses pulses = AllAt(0);
    for (std::size_t i = 0; i < kServos; ++i) {
      const double us = 1450 + 60 * std::sin(0.09 * step * static_cast<double>(i + 1));
      pulses.quarter_us[i] = static_cast<std::uint16_t>(2 * std::lround(2 * us));
    }
    // Long enough for the servos to be there, then two periods are looked at.
    context.Follow(pulses, 60);
    context.Forget();
    context.Follow(pulses, 40);
    for (std::size_t i = 0; i < kServos; ++i) {
      for (const auto& pulse : context.board.TakePulses(i)) {
        worst = std::max(worst, std::abs(pulse.width_us - pulses.quarter_us[i] / 4.0));
      }
    }
  }
  EXPECT_LE(worst, 0.5);
  std::printf("worst width error %.3f us\n", worst);
}

// The pulses of the next period are planned between 8 and 19.5 ms of the present one.
TEST(Firmware, HasTimeAndMemoryEnoughWhateverItDoes) {
  Context context;
  context.board.RunFor(40);
  context.board.Send(context.line.Send(TwelveServos()));
  double longest = 0;
  for (int i = 0; i < 16; ++i) {
    context.Follow(AllAt(i % 2 == 0 ? 2000 : 1000), 60 + 10 * i);  // ramps, with bytes coming
    context.board.RunFor(i % 5 * 50);                              // holds and eases
    for (const auto& tick : context.board.TakeBusy()) {
      longest = std::max(longest, tick.width_us / 1000);
    }
  }
  std::printf("longest tick %.2f ms, %zu bytes never used\n", longest,
              context.board.UntouchedBytes());
  EXPECT_LE(longest, 8);
  EXPECT_GE(context.board.UntouchedBytes(), 200U);
}

TEST(Firmware, StartsAtNeutralAndCrawlsToWhatIsAskedFor) {
  Context context;
  context.board.RunFor(40);
  context.board.Send(context.line.Send(TwelveServos()));
  context.Follow(AllAt(1900), 1500);
  for (std::size_t i = 0; i < kServos; ++i) {
    const auto seen = context.board.TakePulses(i);
    ASSERT_GT(seen.size(), 60U);
    EXPECT_NEAR(seen.front().width_us, 1500, 1.5);
    EXPECT_NEAR(seen.back().width_us, 1900, 0.5);
    double last_step = 0;
    for (std::size_t p = 1; p < seen.size(); ++p) {
      const double step = seen[p].width_us - seen[p - 1].width_us;
      EXPECT_LE(step, 10 + 1.0);                         // 500 us/s, and twice the resolution
      EXPECT_LE(std::abs(step - last_step), 0.8 + 1.5);  // 2000 us/s^2
      last_step = step;
    }
  }
}

// When what happened at a pin, in ms after the last whole frame; nothing where it did not.
struct Failsafe {
  std::optional<double> eases;
  std::optional<double> rests;
  double released = 0;
};

Failsafe Observe(const std::vector<SimulatedBoard::Pulse>& seen, double silent_since_ms,
                 int from_us) {
  Failsafe result;
  for (const auto& pulse : seen) {
    const double ms = pulse.start_us / 1000 - silent_since_ms;
    EXPECT_LE(pulse.width_us, from_us + 0.5);
    EXPECT_GE(pulse.width_us, 1499.5);
    if (!result.eases && pulse.width_us < from_us - 1) result.eases = ms;
    if (!result.rests && pulse.width_us < 1501) result.rests = ms;
    result.released = ms + kPeriodMs;
  }
  return result;
}

// What is decided at a tick shows up to a period later, and its place in the period is the servo's
// own; an ease takes a period or two for its first microsecond.
void ExpectTimes(const Failsafe& seen, double hold_ms, double ease_ms, double release_ms) {
  EXPECT_NEAR(seen.eases.value_or(0), hold_ms + 30, 35);
  EXPECT_NEAR(seen.rests.value_or(0), hold_ms + ease_ms + 10, 35);
  EXPECT_NEAR(seen.released, hold_ms + ease_ms + release_ms + 20, 25);
}

TEST(Firmware, HoldsEasesRestsAndReleasesInItsTimes) {
  Context context;
  context.Start(1800);
  const double silent_since = context.board.now_ms() - kPeriodMs;
  context.board.RunFor(1200);
  for (std::size_t i = 0; i < kServos; ++i) {
    const Failsafe seen = Observe(context.board.TakePulses(i), silent_since, 1800);
    ExpectTimes(seen, 200, 400, 300);
  }
  EXPECT_EQ(context.State(), wire::ReceiverState::kReleased);
  EXPECT_FALSE(context.board.AnyServoHigh());
}

TEST(Firmware, DoesSoWhereverAFrameIsCut) {
  Context context;
  context.board.RunFor(40);
  wire::ServoSetup quick = TwelveServos();
  quick.hold_ms = quick.ease_ms = quick.release_ms = 60;
  for (wire::ServoLimits& servo : quick.servos) {
    servo.ramp_speed_us_s = 4000;
    servo.ramp_acceleration_10us_s2 = 0xFFFF;
  }
  context.board.Send(context.line.Send(quick));
  const std::size_t size = Line().Send(AllAt(1600)).size();
  for (std::size_t cut = 0; cut < size; ++cut) {
    context.Follow(AllAt(1600), 120);
    context.Forget();
    const double silent_since = context.board.now_ms() - kPeriodMs;
    Bytes part = context.line.Send(AllAt(1000));
    part.resize(cut);
    context.board.Send(part);
    context.board.RunFor(240);
    const Failsafe seen = Observe(context.board.TakePulses(cut % kServos), silent_since, 1600);
    ExpectTimes(seen, 60, 60, 60);
    EXPECT_EQ(context.State(), wire::ReceiverState::kReleased);
    EXPECT_FALSE(context.board.AnyServoHigh());
  }
}

TEST(Firmware, ADamagedStreamNeverMovesAServo) {
  Context context;
  context.Start(1600);
  for (int i = 0; i < 100; ++i) {
    Bytes bytes = context.line.Send(AllAt(1200));
    const auto at = 1 + static_cast<std::size_t>(i) % (bytes.size() - 2);
    bytes[at] = static_cast<std::byte>(std::to_integer<int>(bytes[at]) ^ (1 + i));
    context.board.Send(bytes);
    context.board.Send(context.line.Send(AllAt(1600)));
    context.board.RunFor(kPeriodMs);
  }
  for (std::size_t i = 0; i < kServos; ++i) {
    for (const auto& pulse : context.board.TakePulses(i)) EXPECT_NEAR(pulse.width_us, 1600, 0.5);
  }
  context.board.RunFor(1000);
  (void)context.State();
  EXPECT_EQ(context.status.back().damaged, 100U);
  EXPECT_EQ(context.status.back().lost, 100U);
}

TEST(Firmware, AStopEndsMotionWithinAPeriod) {
  Context context;
  context.Start(1000);
  context.Follow(AllAt(2000), 100);
  wire::ServoPulses stop = AllAt(2000);
  stop.stop = true;
  context.board.Send(context.line.Send(stop));
  context.board.RunFor(2 * kPeriodMs);  // to arrive, and one period
  context.Forget();
  context.Follow(stop, 400);
  for (std::size_t i = 0; i < kServos; ++i) {
    const auto seen = context.board.TakePulses(i);
    ASSERT_GT(seen.size(), 15U);
    for (const auto& pulse : seen) EXPECT_NEAR(pulse.width_us, seen.front().width_us, 0.5);
    EXPECT_LT(seen.front().width_us, 1900);
  }
}

TEST(Firmware, AProgramThatHangsIsRestartedAndTheHeadDoesNotJump) {
  Context context;
  context.Start(1800);
  context.board.Hang();
  context.board.RunFor(200);
  EXPECT_EQ(context.State(), wire::ReceiverState::kWaiting);
  EXPECT_EQ(context.status.back().reset_causes, wire::kResetWatchdog);
  EXPECT_FALSE(context.board.AnyServoHigh());
  context.Forget();
  context.board.Send(context.line.Send(TwelveServos()));
  context.Follow(AllAt(1800), 200);
  for (std::size_t i = 0; i < kServos; ++i) {
    for (const auto& pulse : context.board.TakePulses(i)) EXPECT_NEAR(pulse.width_us, 1800, 0.5);
  }
}

TEST(Firmware, TheResetPinDoesNotMakeTheHeadJumpEither) {
  Context context;
  context.Start(1800);
  context.board.Reset();
  context.board.RunFor(100);
  context.Forget();
  context.board.Send(context.line.Send(TwelveServos()));
  context.Follow(AllAt(1800), 200);
  const auto seen = context.board.TakePulses(0);
  ASSERT_FALSE(seen.empty());
  for (const auto& pulse : seen) EXPECT_NEAR(pulse.width_us, 1800, 0.5);
}

}  // namespace
}  // namespace facewire::firmware
