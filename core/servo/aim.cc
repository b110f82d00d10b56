#include "core/servo/aim.h"

#include <algorithm>

namespace facewire::servo {
namespace {

bool IsWithin(const std::optional<Duration>& last, Duration now, Duration time) noexcept {
  return last && now - *last <= time;
}

// 1 to 0, without a jump in speed.
double Fade(Duration elapsed, Duration whole) noexcept {
  if (elapsed >= whole) return 0;
  const double t = static_cast<double>(elapsed.count()) / static_cast<double>(whole.count());
  return 1 - t * t * (3 - 2 * t);
}

bool IsNeutral(Activity a) noexcept { return a == Activity::kEasing || a == Activity::kResting; }

}  // namespace

void Aim::Configure(const Servo& servo, const ServoRig& rig, double step) noexcept {
  *this = Aim();
  contract_ = rig.contract;
  neutral_ = goal_ = held_ = servo.neutral;
  follower_.Configure(servo, rig.following, step);
}

void Aim::TakeWish(double position, Duration now, Duration interval) noexcept {
  if (!IsWithin(last_wish_, now, contract_.fresh)) follower_.Reset();
  follower_.Take(position, now, interval);
  last_wish_ = now;
}

void Aim::TakeManual(double position, Duration now) noexcept {
  manual_ = position;
  last_manual_ = now;
}

Activity Aim::Decide(Duration now) const noexcept {
  if (!last_wish_ && !last_manual_) return Activity::kWaiting;
  if (IsWithin(last_manual_, now, contract_.fresh)) return Activity::kManual;
  if (IsWithin(last_wish_, now, contract_.fresh)) return Activity::kFollowing;
  const Duration silent =
      now - std::max(last_wish_.value_or(Duration::min()), last_manual_.value_or(Duration::min()));
  Duration until = contract_.fresh + contract_.hold;
  if (silent <= until) return Activity::kHolding;
  if (silent <= (until += contract_.ease)) return Activity::kEasing;
  return silent <= until + contract_.limp ? Activity::kResting : Activity::kLimp;
}

double Aim::Base(Duration now) const noexcept {
  switch (activity_) {
    case Activity::kFollowing:
      return follower_.GoalAt(now);
    case Activity::kManual:
      return manual_;
    case Activity::kHolding:
      return held_;
    default:
      return neutral_;
  }
}

void Aim::Switch(Activity next, Duration now) noexcept {
  const Activity before = activity_;
  activity_ = next;
  if (IsNeutral(before) && IsNeutral(next)) return;  // the fade goes on
  held_ = goal_;
  // Torque comes back at the servo's own position, and its crawl is the hand-over.
  offset_ = IsAlive(before) ? goal_ - Base(now) : 0;
  switched_ = now;
  blend_ = IsNeutral(next) ? contract_.ease : kHandOver;
}

Activity Aim::Update(Duration now) noexcept {
  const Activity next = Decide(now);
  if (next != activity_) Switch(next, now);
  goal_ = Base(now) + offset_ * Fade(now - switched_, blend_);
  return activity_;
}

}  // namespace facewire::servo
