#ifndef FACEWIRE_CORE_RETARGET_SOFT_RANGE_H_
#define FACEWIRE_CORE_RETARGET_SOFT_RANGE_H_

#include <algorithm>
#include <cmath>

namespace facewire::retarget {

// The range that a signal's targets span in training, and the way into its ends.
struct SoftRange {
  // Part of the range over which values bend into an end.
  static constexpr float kKnee = 0.1F;

  float low = 0, high = 0, neutral = 0;
  // Part of the way from the neutral to either end, below 1/2, that is taken for noise: it fades
  // out smoothly, and so much more is added towards the end that the middle of the way stays put.
  float dead_zone = 0;

  // Never outside [low, high], monotone, without a kink, and exact at both ends and everywhere
  // farther than the knee from them: so trained poses come out as they were trained (without a dead
  // zone). A neutral is never bent: where an end is nearer to it than the knee, the knee is that
  // much shorter, and an end that is the neutral (a blend shape's 0) just stops. What is not finite
  // is the neutral.
  float Limit(float x) const noexcept {
    if (!std::isfinite(x)) return neutral;
    if (dead_zone > 0)
      x = x > neutral ? neutral + Fade(x - neutral, high - neutral)
                      : neutral - Fade(neutral - x, neutral - low);
    const float knee = kKnee * (high - low);
    return x > neutral ? Bend(x, high, std::min(knee, high - neutral))
                       : -Bend(-x, -low, std::min(knee, neutral - low));
  }

 private:
  // A parabola that leaves 0 with slope 0 and meets the line through the middle of the way.
  float Fade(float way, float length) const noexcept {
    const float zone = dead_zone * length;
    const float left = way < 2 * zone ? way * way / (4 * zone) : way - zone;
    return left / (1 - 2 * dead_zone);
  }
  // The cubic that leaves x at end - knee with slope 1 and reaches the end there with slope 0.
  static float Bend(float x, float end, float knee) noexcept {
    if (x >= end) return end;
    const float t = (x - (end - knee)) / knee;
    return t > 0 ? std::min(end, end - knee + knee * t * (1 + t * (1 - t))) : x;
  }
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_SOFT_RANGE_H_
