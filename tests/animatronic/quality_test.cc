#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/animatronic/performers.h"
#include "tests/animatronic/stage.h"

// What a still face costs and what a moving one loses, on its way from the camera's frame to the
// wire of each bus and to the servo's shaft.

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kSettles = seconds(12);
constexpr int kSeconds = FACEWIRE_QUALITY_SECONDS;

// All servos of a stage, once a millisecond, as parts of their ranges.
struct Record {
  std::vector<double> wished, told, shaft;
  std::size_t changes = 0;
};

double RootMeanSquare(const std::vector<double>& clean, const std::vector<double>& late,
                      std::size_t lag) {
  double sum = 0;
  for (std::size_t i = lag; i < clean.size(); ++i) {
    sum += (late[i] - clean[i - lag]) * (late[i] - clean[i - lag]);
  }
  return std::sqrt(sum / static_cast<double>(clean.size() - lag));
}

struct Quality {
  std::size_t lag_ms = 0;  // where the two are most alike
  double off = 0;          // and how much they differ there, part of the range
};
Quality QualityOf(const std::vector<double>& clean, const std::vector<double>& late) {
  Quality best{0, 1};
  for (std::size_t lag = 0; lag < 300; ++lag) {
    const double off = RootMeanSquare(clean, late, lag);
    if (off < best.off) best = {lag, off};
  }
  return best;
}

// Servo 0 of each bus.
std::vector<Record> Watch(Stage& stage, const Stage::Performer& clean, std::uint64_t seed) {
  Tremble tremble(seed);
  stage.performer = [&](std::size_t servo, double t_s) {
    return clean(servo, t_s) + tremble(servo, t_s);
  };
  stage.Run(kSettles);
  EXPECT_TRUE(stage.AllOn());
  std::vector<Record> records(stage.servos());
  std::vector<double> goals(stage.servos());
  for (std::size_t i = 0; i < stage.servos(); ++i) goals[i] = stage.seen(i).goal;
  stage.on_look = [&] {
    for (std::size_t i = 0; i < stage.servos(); ++i) {
      const Seen& seen = stage.seen(i);
      records[i].wished.push_back(clean(i, stage.now_s()));
      records[i].told.push_back(stage.Part(i, seen.goal));
      records[i].shaft.push_back(stage.Part(i, seen.position));
      records[i].changes += seen.goal != std::exchange(goals[i], seen.goal) ? 1 : 0;
    }
  };
  stage.Run(seconds(kSeconds));
  stage.on_look = {};
  EXPECT_EQ(stage.judge->Report(), "");
  return records;
}

double Still(std::size_t /*servo*/, double /*t_s*/) { return 0.5; }

TEST(StillFace, ChangesNoCommandMoreThanOnceASecondAtTheWireOfAnyBus) {
  std::printf("| bus        | changes a second, worst servo |\n");
  Stage stage(EveryKind(3));
  const std::vector<Record> records = Watch(stage, Still, 1);
  for (std::size_t bus = 0; bus < stage.lines().size(); ++bus) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < stage.servos(); ++i) {
      if (&stage.line_of(i) == &stage.line(bus)) most = std::max(most, records[i].changes);
    }
    const double rate = static_cast<double>(most) / kSeconds;
    std::printf("| %-10s | %.3f |\n", Name(stage.line(bus).options().kind), rate);
    EXPECT_LT(rate, 1) << Name(stage.line(bus).options().kind);
  }
}

// From the camera's frame, of which the wishes come 0 to 12 ms late, to what the bus has
// understood, and to the shaft. The servo's own lag is that of the simulated physics.
TEST(MovingFace, LagAndNoiseOfEverySettingOnEveryBus) {
  std::printf(
      "| calm | lead | bus        | still: changes/s | lag told | off | lag shaft | off |\n");
  for (const float calm : {0.F, 1.F, 2.F, 3.F, 5.F, 8.F}) {
    for (const int lead_ms : {0, 15, 33}) {
      StageOptions options = EveryKind(1);
      options.following = {.calm = calm, .lead = milliseconds(lead_ms)};
      Stage still_stage(options);
      Stage stage(options);
      const std::vector<Record> still = Watch(still_stage, Still, 1);
      const std::vector<Record> moving = Watch(stage, Moving, 1);
      for (std::size_t i = 0; i < stage.servos(); ++i) {
        const Quality told = QualityOf(moving[i].wished, moving[i].told);
        const Quality shaft = QualityOf(moving[i].wished, moving[i].shaft);
        const Kind kind = stage.line_of(i).options().kind;
        std::printf(
            "| %4.0f | %2d ms | %-10s | %5.2f | %3zu ms | %4.2f %% | %3zu ms | %4.2f %% |\n", calm,
            lead_ms, Name(kind), static_cast<double>(still[i].changes) / kSeconds, told.lag_ms,
            100 * told.off, shaft.lag_ms, 100 * shaft.off);
        EXPECT_LT(static_cast<double>(still[i].changes) / kSeconds, calm >= 3 ? 1 : 60);
        EXPECT_LT(told.lag_ms, 80 + calm) << Name(kind);
        EXPECT_LT(shaft.lag_ms, 130 + calm) << Name(kind);
        EXPECT_LT(told.off, 0.03) << Name(kind);
        EXPECT_LT(shaft.off, 0.03) << Name(kind);
      }
    }
  }
}

// A trajectory without noise, slow enough for every servo: the shaft follows what the bus was told
// within the bus's step, the servo's dead band, half its play and its sensor's noise and step.
TEST(SmoothMotion, IsFollowedWithinTheBusesStepAndTheServosOwnError) {
  std::printf("| bus        | bus's step | servo's own error | found |\n");
  Stage stage(EveryKind(2));
  stage.performer = [](std::size_t servo, double t_s) {
    return 0.5 + 0.3 * std::sin(0.8 * t_s + static_cast<double>(servo));
  };
  stage.Run(kSettles);
  ASSERT_TRUE(stage.AllOn());
  std::vector<std::vector<double>> told(stage.servos()), shaft(stage.servos());
  stage.on_look = [&] {
    for (std::size_t i = 0; i < stage.servos(); ++i) {
      const double degrees = DegreesPerUnit(stage.line_of(i).options().kind);
      told[i].push_back(stage.seen(i).commanded * degrees);
      shaft[i].push_back(stage.seen(i).position * degrees);
    }
  };
  stage.Run(seconds(kSeconds));
  EXPECT_EQ(stage.judge->Report(), "");
  for (std::size_t i = 0; i < stage.servos(); ++i) {
    const Kind kind = stage.line_of(i).options().kind;
    const Quality quality = QualityOf(told[i], shaft[i]);
    // The worst of it, once the servo's lag is taken out.
    double worst = 0;
    for (std::size_t t = quality.lag_ms; t < told[i].size(); ++t) {
      worst = std::max(worst, std::abs(shaft[i][t] - told[i][t - quality.lag_ms]));
    }
    const sim::ServoParameters& servo =
        stage.line_of(i).bus().servo(stage.index_of(i)).parameters();
    const double own = (servo.dead_band_rad + servo.backlash_rad / 2 + servo.sensor_noise_rad +
                        servo.sensor_step_rad / 2) /
                       sim::kDegree;
    const double step = stage.line_of(i).wire(stage.index_of(i)).step * DegreesPerUnit(kind);
    // What it moves from one of its frames of 20 ms to the next.
    const double frame = IsPulses(kind) ? 0.3 * 0.8 * 90 * 0.02 : 0;
    if (stage.index_of(i) == 0) {
      std::printf("| %-10s | %.3f | %.3f | %.3f (%zu ms late) |\n", Name(kind), step, own + frame,
                  worst, quality.lag_ms);
    }
    EXPECT_LT(worst, step + own + frame) << Name(kind);
  }
}

}  // namespace
}  // namespace facewire::stage
