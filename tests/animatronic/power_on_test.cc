#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <vector>

#include "tests/animatronic/stage.h"

// Power-on from random poses: how fast the servos themselves move.

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Speed and acceleration of a shaft that trembles with its sensor and its gears' play: of the mean
// motion over a tenth of a second.
class Watch {
 public:
  static constexpr std::size_t kWindow = 100;  // ms

  void Look(double position) {
    positions_.push_back(position);
    if (positions_.size() <= kWindow) return;
    positions_.pop_front();
    const double speed = (positions_.back() - positions_.front()) / ((kWindow - 1) * 1e-3);
    speed_ = std::max(speed_, std::abs(speed));
    speeds_.push_back(speed);
    if (speeds_.size() <= kWindow) return;
    speeds_.pop_front();
    const double change = (speeds_.back() - speeds_.front()) / ((kWindow - 1) * 1e-3);
    acceleration_ = std::max(acceleration_, std::abs(change));
  }
  double speed() const { return speed_; }  // per second
  double acceleration() const { return acceleration_; }

 private:
  std::deque<double> positions_, speeds_;
  double speed_ = 0, acceleration_ = 0;
};

struct Peaks {
  double speed = 0, acceleration = 0;  // degrees
};

// `after`: from when on it is watched, counted from the servo's torque.
Peaks PowerOn(Kind kind, std::uint64_t seed, Duration after) {
  StageOptions options = OneKind(kind, 3);
  sim::Random random(seed);
  const servo::Servo servo = ServoOf(kind, 0, 1);
  for (int i = 0; i < 3; ++i) {
    options.lines[0].poses.push_back(random.Between(servo.min, servo.max));
  }
  options.lines[0].seed = seed;
  Stage stage(options);
  std::vector<Watch> watches(3);
  std::vector<std::optional<Time>> on(3);
  const double there = random.Between(0.1, 0.9);
  stage.performer = [&](std::size_t, double) { return there; };
  stage.on_look = [&] {
    for (std::size_t i = 0; i < 3; ++i) {
      if (stage.seen(i).torque && !on[i]) on[i] = stage.now();
      if (on[i] && stage.now() >= *on[i] + after) watches[i].Look(stage.seen(i).position);
    }
  };
  stage.Run(seconds(8));
  EXPECT_TRUE(stage.AllOn()) << Name(kind) << ' ' << seed;
  EXPECT_EQ(stage.judge->Report(), "") << Name(kind) << ' ' << seed;
  Peaks peaks;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(stage.Part(i, stage.seen(i).position), there, 0.03) << Name(kind) << ' ' << seed;
    peaks.speed = std::max(peaks.speed, watches[i].speed() * DegreesPerUnit(kind));
    peaks.acceleration =
        std::max(peaks.acceleration, watches[i].acceleration() * DegreesPerUnit(kind));
  }
  return peaks;
}

// What the gears' play and the sensor's noise add to the motion of a shaft within the window.
double Play(Kind kind) { return kind == Kind::kDynamixel ? 0.35 : 1.1; }

void ExpectCrawl(Kind kind, const Peaks& peaks) {
  const double window_s = Watch::kWindow * 1e-3;
  const servo::Servo servo = ServoOf(kind, 0, 1);
  const double crawl = servo.crawl_speed_per_s * DegreesPerUnit(kind);
  const double acceleration = crawl * servo.max_acceleration_per_s2 / servo.max_speed_per_s;
  // A Dynamixel's own speed has steps of 1.4 degrees a second.
  const double most = 1.08 * crawl + Play(kind) / window_s;
  const double most_acceleration = acceleration + Play(kind) / (window_s * window_s);
  std::printf("| %-10s | %5.1f | %5.1f | %5.0f | %5.0f |\n", Name(kind), peaks.speed, most,
              peaks.acceleration, most_acceleration);
  EXPECT_LE(peaks.speed, most) << Name(kind);
  EXPECT_LE(peaks.acceleration, most_acceleration) << Name(kind);
  EXPECT_GT(peaks.speed, 0.8 * crawl) << Name(kind);  // it does move
}

Peaks Worst(Kind kind, Duration after) {
  Peaks worst;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Peaks peaks = PowerOn(kind, seed, after);
    worst.speed = std::max(worst.speed, peaks.speed);
    worst.acceleration = std::max(worst.acceleration, peaks.acceleration);
  }
  return worst;
}

TEST(PowerOn, FromAnyPoseCrawlsOnEveryBusThatTellsWhereItsServosAre) {
  std::printf("peaks in degrees/s and degrees/s^2\n");
  std::printf("| bus        | speed | most  | accel | most  |\n");
  for (const Kind kind : kKinds) {
    if (!IsPulses(kind)) ExpectCrawl(kind, Worst(kind, Duration{}));
  }
}

// The limit of a servo behind pulses: nobody knows where it is, and its first pulse makes it jump
// there as fast as it can. What can be promised is where that is, and all that comes after.
TEST(PowerOn, OfAServoThatCannotTellJumpsToItsFirstPulseAndCrawlsFromThere) {
  constexpr Duration kJump = milliseconds(500);
  for (const Kind kind : {Kind::kMaestro, Kind::kReceiver}) {
    ExpectCrawl(kind, Worst(kind, kJump));
    const Peaks jump = PowerOn(kind, 1, Duration{});
    std::printf("| its jump   | %5.1f |\n", jump.speed);
    EXPECT_GT(jump.speed, 60);  // said openly
  }
}

TEST(PowerOn, GivesTheFirstPulseAtNeutral) {
  for (const Kind kind : {Kind::kMaestro, Kind::kReceiver}) {
    Stage stage(OneKind(kind, 3));
    stage.performer = [](std::size_t, double) { return 0.9; };
    std::vector<double> first(3);
    stage.on_look = [&] {
      for (std::size_t i = 0; i < 3; ++i) {
        if (stage.seen(i).torque && first[i] == 0) first[i] = stage.seen(i).commanded;
      }
    };
    stage.Run(seconds(4));
    // They begin one after the other; a crawl is not far by then.
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(first[i], 1500, 200 * 0.15) << Name(kind);
  }
}

// The host's program restarts, its buses do not: the servos keep their torque, and motion goes on
// from where they are.
TEST(PowerOn, OfAHostWhoseServosStillHaveTheirTorqueGoesOnFromThere) {
  for (const Kind kind : kKinds) {
    Stage stage(OneKind(kind, 3));
    stage.performer = [](std::size_t servo, double) {
      return 0.3 + 0.2 * static_cast<double>(servo);
    };
    ASSERT_TRUE(stage.RunUntil([&] { return stage.AllOn(); }, seconds(5)));
    stage.Run(seconds(5));
    std::vector<double> before;
    for (std::size_t i = 0; i < 3; ++i) before.push_back(stage.seen(i).position);
    stage.Restart();
    double astray = 0;
    bool limp = false;
    stage.on_look = [&] {
      for (std::size_t i = 0; i < 3; ++i) {
        astray = std::max(astray, std::abs(stage.seen(i).position - before[i]));
        limp = limp || !stage.seen(i).torque;
      }
    };
    stage.Run(seconds(4));
    EXPECT_TRUE(stage.AllOn()) << Name(kind);
    EXPECT_EQ(stage.judge->Report(), "") << Name(kind);
    EXPECT_LE(astray * DegreesPerUnit(kind), 1.5) << Name(kind);
    EXPECT_FALSE(limp) << Name(kind);
  }
}

// A servo that was moved by hand beyond its limits is led back at its arrival's own pace.
TEST(PowerOn, BeyondTheLimitsGoesBackSlowly) {
  for (const Kind kind : kKinds) {
    if (IsPulses(kind)) continue;
    StageOptions options = OneKind(kind, 1);
    const servo::Servo servo = ServoOf(kind, 0, 1);
    const double out = 20 / DegreesPerUnit(kind);
    options.lines[0].poses = {servo.max + out};
    Stage stage(options);
    Watch watch;
    stage.on_look = [&] {
      if (stage.seen(0).torque) watch.Look(stage.seen(0).position);
    };
    stage.Run(seconds(8));
    EXPECT_TRUE(stage.AllOn()) << Name(kind);
    EXPECT_EQ(stage.judge->Report(), "") << Name(kind);
    EXPECT_NEAR(stage.Part(0, stage.seen(0).position), 0.5, 0.03);
    ExpectCrawl(
        kind, {watch.speed() * DegreesPerUnit(kind), watch.acceleration() * DegreesPerUnit(kind)});
  }
}

}  // namespace
}  // namespace facewire::stage
