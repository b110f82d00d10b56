#include "core/limit/limiter.h"

#include <algorithm>
#include <cmath>

namespace facewire::limit {
namespace {

bool IsLimit(float maximum) noexcept { return std::isfinite(maximum) && maximum >= 0; }

bool IsValid(const facewire::Channel& c) noexcept {
  // Comparisons with NaN are false, so this refuses NaN as well.
  return std::isfinite(c.min) && std::isfinite(c.max) && c.min <= c.neutral && c.neutral <= c.max &&
         IsLimit(c.max_speed_per_s) && IsLimit(c.max_acceleration_per_s2);
}

}  // namespace

Result<> Limiter::Configure(const Rig& rig) noexcept {
  if (!std::ranges::all_of(rig.channels, IsValid)) return Errc::kOutOfRange;
  count_ = rig.channels.size();
  for (std::size_t i = 0; i < count_; ++i) {
    const facewire::Channel& from = rig.channels[i];
    channels_[i] = {.min = from.min,
                    .max = from.max,
                    .neutral = from.neutral,
                    .limits = {from.max_speed_per_s, from.max_acceleration_per_s2}};
  }
  Reset(rig.NeutralPose());
  return {};
}

void Limiter::Reset(const RigPose& pose) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    Channel& c = channels_[i];
    const bool given = i < pose.count && !std::isnan(pose.values[i]);
    c.target = given ? std::clamp(pose.values[i], c.min, c.max) : c.neutral;
    c.motion = {c.target, 0};
  }
  last_.reset();
}

double Limiter::StepSeconds(Time now) noexcept {
  const Duration step = last_ ? Between(*last_, now) : Duration::zero();
  if (last_ && step <= Duration::zero() && step >= -kMaxStep) return 0;
  last_ = now;
  if (step <= kMaxStep && step >= Duration::zero())
    return std::chrono::duration<double>(step).count();
  for (std::size_t i = 0; i < count_; ++i) channels_[i].motion.speed_per_s = 0;
  return step > Duration::zero() ? std::chrono::duration<double>(kMaxStep).count() : 0;
}

RigPose Limiter::Update(const RigPose& target, Time now) noexcept {
  const double dt_s = StepSeconds(now);
  RigPose out{.seq = target.seq, .captured = target.captured, .count = count_};
  for (std::size_t i = 0; i < count_; ++i) {
    Channel& c = channels_[i];
    if (i < target.count && !std::isnan(target.values[i])) {
      c.target = std::clamp(target.values[i], c.min, c.max);
    }
    c.motion = MoveTowards(c.target, c.motion, c.limits, dt_s);
    // Braking in time keeps the motion inside already; this is for the last bit of rounding.
    const double inside = std::clamp<double>(c.motion.position, c.min, c.max);
    if (inside != c.motion.position) c.motion = {inside, 0};
    out.values[i] = static_cast<float>(inside);
  }
  return out;
}

}  // namespace facewire::limit
