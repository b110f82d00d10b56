#ifndef FACEWIRE_CORE_FILTER_LANDMARK_FILTER_H_
#define FACEWIRE_CORE_FILTER_LANDMARK_FILTER_H_

#include "core/base/result.h"
#include "core/landmarks.h"

namespace facewire::filter {

struct OneEuroConfig {
  float min_cutoff_hz;         // lower = less jitter in a still face, more lag at the start of a motion
  float beta;                  // raises the cut-off with speed (in face sizes per second): less lag
  float derivative_cutoff_hz;  // smoothing of the speed itself
};

struct FilterConfig {
  OneEuroConfig eyes{0.05F, 80.0F, 1.0F};
  OneEuroConfig mouth{0.05F, 80.0F, 1.0F};
  OneEuroConfig rest{0.05F, 80.0F, 1.0F};
};

// Takes the jitter out of landmarks and catches failed tracking.
class LandmarkFilter {
 public:
  explicit LandmarkFilter(const FilterConfig& config) noexcept;
  // Forgets the past; the next landmarks pass unfiltered.
  void Reset() noexcept;
  // kRejected: the measurement cannot be right (jump, collapse, presence); the caller treats the face as lost.
  Result<Landmarks> Update(const Landmarks& in) noexcept;
};

}  // namespace facewire::filter

#endif  // FACEWIRE_CORE_FILTER_LANDMARK_FILTER_H_
