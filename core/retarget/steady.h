#ifndef FACEWIRE_CORE_RETARGET_STEADY_H_
#define FACEWIRE_CORE_RETARGET_STEADY_H_

#include <array>
#include <chrono>
#include <optional>
#include <span>

#include "core/base/capacity.h"
#include "core/base/time.h"

namespace facewire::retarget {

// Takes what is left of the tracker's noise out of signals: each follows its input by the part
//     d^2 / (d^2 + h^2)   a 30th of a second,   h = kNoise of the signal's range
// of the distance d that is left. What moves by several h (a blink) passes at once; what trembles
// within h is an average. No cut-off frequency has to be chosen, because expressions are told from
// noise by size: the landmarks' own filter (core/filter) has taken out what can be told by speed.
class Steady {
 public:
  // Part of a range. Measured: parameters of a still face vary by up to 0.015 without this; with
  // 0.04 correlation and error against true weights are best, with 0.08 slow motion lags.
  static constexpr float kNoise = 0.04F;
  // After such a silence the next input is taken as it is.
  static constexpr Duration kSilence = std::chrono::milliseconds(200);

  void Reset() noexcept { before_.reset(); }

  // `ranges`: one per signal, >= 0; 0: passed on as it is. `signals`: finite, at most kMaxSignals,
  // overwritten. When `captured` does not advance they pass, too.
  void Update(Time captured, std::span<const float> ranges, std::span<float> signals) noexcept;

 private:
  std::optional<Time> before_;
  std::array<float, kMaxSignals> values_{};
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_STEADY_H_
