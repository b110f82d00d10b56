#include "core/retarget/steady.h"

#include <algorithm>
#include <cmath>

namespace facewire::retarget {

void Steady::Update(Time captured, std::span<const float> ranges,
                    std::span<float> signals) noexcept {
  const Duration step = before_ ? Between(*before_, captured) : Duration::zero();
  const bool follows = step > Duration::zero() && step <= kSilence;
  const float steps = 30 * Seconds(step);
  for (std::size_t i = 0; follows && i < signals.size(); ++i) {
    const float noise = kNoise * ranges[i];
    const float left = signals[i] - values_[i];
    if (noise <= 0 || left == 0) continue;
    const float kept = noise * noise / (left * left + noise * noise);
    signals[i] -= left * std::pow(kept, steps);
  }
  std::ranges::copy(signals, values_.begin());
  before_ = captured;
}

}  // namespace facewire::retarget
