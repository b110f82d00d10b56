// An hour of everything that can go wrong, and what must never happen.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "core/servo/motion.h"
#include "tests/core/servo/generated_servos.h"

namespace facewire::servo {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr std::size_t kServos = 6;

// Watches one servo's commands.
struct Watch {
  double before = 0;
  double change = 0;  // of the last tick
  double since_s = 0;
  bool torque = false;
};

class Hour {
 public:
  explicit Hour(unsigned seed) : random_(seed), dt_s_(1 / Between(50, 200)) {
    for (std::size_t i = 0; i < kServos; ++i) AddServo(i);
    AddRule(0, 1, Relation::kAtLeast, 1, -150);   // upper lid over eye
    AddRule(2, 1, Relation::kAtMost, 0.7F, 600);  // lower lid under eye
    AddRule(0, 2, Relation::kAtLeast, 1, -100);   // lids over each other
    rig_.following.calm = static_cast<float>(Between(0, 5));
    rig_.following.lead = microseconds(static_cast<int>(Between(0, 60'000)));
    if (Chance(0.5)) rig_.contract.stop_torque = milliseconds(500);
    EXPECT_FALSE(FindFlaw(rig_));
    EXPECT_TRUE(motion_->Configure(rig_, actuators_));
    now_ = latest_ = Time(seconds(1000));
    for (std::size_t i = 0; i < kServos; ++i) watches_[i].before = rig_.servos[i].neutral;
  }

  void Run(Duration time) {
    for (Duration ran{}; ran < time && !testing::Test::HasFailure();) {
      Disturb();
      now_ += Leap();
      // A step back is no time until it is made up for, a leap back a new clock.
      const Duration step = now_ - latest_;
      if (step > Duration::zero() || step < -Motion::kLongestTick) latest_ = now_;
      ran += std::chrono::duration_cast<Duration>(std::chrono::duration<double>(dt_s_));
      const bool counts = step > Duration::zero() && step <= Motion::kLongestTick;
      passed_s_ = counts ? std::chrono::duration<double>(step).count() : 0;
      if (step > Duration::zero()) silent_ += step;
      const Commands& out = motion_->Tick(now_);
      ASSERT_EQ(out.count, kServos);
      for (std::size_t i = 0; i < kServos; ++i) Check(i, out.servos[i]);
      CheckRules(out);
    }
  }
  std::size_t moves() const { return moves_; }
  std::size_t limps() const { return limps_; }

 private:
  double Between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool Chance(double p) { return Between(0, 1) < p; }

  void AddServo(std::size_t i) {
    const bool pulses = i % 2 == 0;
    const std::string name = "s" + std::to_string(i);
    const auto id = static_cast<std::uint8_t>(i);
    Servo servo = pulses ? PulseServo(name, id) : CountServo(name, id);
    servo.min = static_cast<float>(Between(900, 1100));
    servo.max = static_cast<float>(Between(1900, 2100));
    servo.neutral = 1500;
    servo.dead_band = static_cast<float>(Between(0, 6));
    servo.backlash = static_cast<float>(Between(0, 10));
    servo.max_speed_per_s = static_cast<float>(std::pow(10, Between(1.5, 4)));
    servo.max_acceleration_per_s2 =
        Chance(0.2) ? 0 : servo.max_speed_per_s * static_cast<float>(Between(1, 30));
    servo.crawl_speed_per_s = servo.max_speed_per_s * static_cast<float>(Between(0.02, 1));
    if (Chance(0.4)) servo.limp_after = milliseconds(static_cast<int>(Between(200, 3000)));
    ASSERT_TRUE(rig_.servos.try_push(servo));
    actuators_.push_back({.step = pulses ? 0.25F : 1, .reads_back = !pulses});
  }
  void AddRule(std::uint8_t yields, std::uint8_t other, Relation relation, float gain,
               float offset) {
    Linkage rule{*ShortName::From("rule"), yields, other, relation, gain, offset};
    ASSERT_TRUE(rig_.linkages.try_push(rule));
  }

  float AnyPosition() {
    if (Chance(0.02)) return kNan;
    if (Chance(0.02)) return Chance(0.5) ? kInfinity : -kInfinity;
    return static_cast<float>(Between(700, 2300));
  }

  // Whatever may come in between two ticks.
  void Disturb() {
    if (Chance(dt_s_ / 20)) dropout_s_ = std::pow(10, Between(-1.5, 1.3));
    dropout_s_ -= dt_s_;
    frame_s_ -= dt_s_;
    if (dropout_s_ <= 0 && frame_s_ <= 0) SendWishes();
    if (Chance(dt_s_ / 5))
      by_hand_ = Chance(0.3) ? std::optional(random_() % (kServos + 1)) : std::nullopt;
    if (by_hand_ && Chance(0.5)) {
      const float position = AnyPosition();
      motion_->SetManual(*by_hand_, position, now_);
      if (*by_hand_ < kServos && !std::isnan(position)) silent_ = Duration::zero();
    }
    if (Chance(dt_s_ / 5)) {
      motion_->SetHealth(random_() % kServos,
                         Chance(0.3) ? 0 : static_cast<float>(Between(-0.2, 1.5)));
    }
    for (std::size_t i = 1; i < kServos; i += 2) {
      if (Chance(0.2)) motion_->SetReading(i, static_cast<float>(watches_[i].before), now_);
    }
    if (Chance(dt_s_ / 30)) motion_->Stop();
    if (motion_->stopped() && Chance(dt_s_ / 2)) {
      motion_->Release();
      for (Watch& watch : watches_) watch.change = 0;
    }
  }

  void SendWishes() {
    frame_s_ = Between(0.015, 0.05);
    Wishes wishes{.captured = now_ - milliseconds(40), .count = kServos};
    if (Chance(0.01)) wishes.count = random_() % 3;
    if (Chance(0.01)) wishes.captured += seconds(static_cast<int>(Between(-1000, 1000)));
    for (std::size_t i = 0; i < kServos; ++i) {
      if (Chance(0.03)) aims_[i] = AnyPosition();
      wishes.positions[i] = aims_[i] + static_cast<float>(Between(-4, 4));
    }
    motion_->Take(wishes, now_);
    silent_ = Duration::zero();
  }

  Duration Leap() {
    if (Chance(0.0005)) return -microseconds(static_cast<int>(Between(0, 90'000)));
    if (Chance(0.0002)) return -seconds(static_cast<int>(Between(1, 500)));
    if (Chance(0.0005)) return milliseconds(static_cast<int>(Between(101, 20'000)));
    const double jitter = Chance(0.2) ? Between(0.3, 2) : 1;
    return microseconds(static_cast<int>(1e6 * dt_s_ * jitter));
  }

  void Check(std::size_t i, const Command& command) {
    const Servo& servo = rig_.servos[i];
    const double step = actuators_[i].step;
    Watch& watch = watches_[i];
    const double change = command.position - watch.before;
    watch.since_s += passed_s_;
    ASSERT_GE(command.position, servo.min);
    ASSERT_LE(command.position, servo.max);
    ASSERT_EQ(std::remainder(command.position, step), 0);
    ASSERT_EQ(command.changed, change != 0 || command.torque != watch.torque);
    ASSERT_EQ(command.torque, IsAlive(command.activity) ||
                                  (command.activity == Activity::kStopped && command.torque));
    if (motion_->stopped()) {
      ASSERT_EQ(change, 0) << "motion after a stop";
      ASSERT_TRUE(watch.torque || !command.torque) << "torque after a stop";
    }
    const Contract& c = rig_.contract;
    if (silent_ > c.fresh + c.hold + c.ease + c.limp) {
      ASSERT_FALSE(command.torque) << "torque after the contract's time";
    }
    const bool came_on = command.torque && !watch.torque;
    if (came_on) {
      ++limps_;  // here the servo is put where it is
      ASSERT_NEAR(change, 0, step) << "this test reads back what was commanded";
    } else {
      const double speed = servo.max_speed_per_s;
      const double due = speed * watch.since_s >= step * (1 - 1e-6) ? step : 0;
      ASSERT_LE(std::abs(change), std::max(speed * passed_s_, due) * (1 + 1e-6))
          << "servo " << i << " at " << now_.time_since_epoch().count();
      CheckAcceleration(servo, step, change, watch, command.torque);
    }
    if (change != 0) {
      ++moves_;
      watch.since_s = 0;
    }
    watch.before = command.position;
    watch.torque = command.torque;
    watch.change = change;
  }

  // Between two ticks of the same length; a stop, a leap of time and the loss of torque end a
  // motion as they find it.
  void CheckAcceleration(const Servo& servo, double step, double change, const Watch& watch,
                         bool torque) const {
    if (servo.max_acceleration_per_s2 == 0 || motion_->stopped() || !torque || !watch.torque)
      return;
    if (std::abs(passed_s_ - passed_before_s_) > 1e-9 || passed_s_ == 0) return;
    ASSERT_LE(std::abs(change - watch.change),
              servo.max_acceleration_per_s2 * passed_s_ * passed_s_ * (1 + 1e-6) + 2 * step);
  }

  void CheckRules(const Commands& out) {
    passed_before_s_ = passed_s_;
    for (std::size_t r = 0; r < rig_.linkages.size(); ++r) {
      const Linkage& rule = rig_.linkages[r];
      const double bound = double{rule.gain} * out.servos[rule.other].position + rule.offset;
      const double at = out.servos[rule.yields].position;
      ASSERT_GE(rule.relation == Relation::kAtLeast ? at - bound : bound - at, -1e-3)
          << "rule " << r << " at " << now_.time_since_epoch().count();
    }
  }

  std::mt19937 random_;
  double dt_s_;
  ServoRig rig_;
  std::vector<Actuator> actuators_;
  std::unique_ptr<Motion> motion_ = std::make_unique<Motion>();
  Time now_;
  Time latest_;
  double passed_s_ = 0;
  double passed_before_s_ = 0;
  Duration silent_{};  // since anybody wished anything
  double dropout_s_ = 0;
  double frame_s_ = 0;
  std::optional<std::size_t> by_hand_;
  std::array<float, kServos> aims_{1500, 1500, 1500, 1500, 1500, 1500};
  std::array<Watch, kServos> watches_{};
  std::size_t moves_ = 0;
  std::size_t limps_ = 0;
};

TEST(MotionProperty, AnHourOfFaultsBreaksNoLimitNoStopNoContractAndNoRule) {
  std::size_t moves = 0;
  std::size_t limps = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Hour part(seed);
    part.Run(minutes(2));
    if (testing::Test::HasFailure()) return;
    moves += part.moves();
    limps += part.limps();
  }
  EXPECT_GT(moves, 100'000U) << "it was not for want of motion";
  EXPECT_GT(limps, 1'000U);
}

}  // namespace
}  // namespace facewire::servo
