#ifndef FACEWIRE_CORE_FILTER_LANDMARK_FILTER_H_
#define FACEWIRE_CORE_FILTER_LANDMARK_FILTER_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/capacity.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/filter/plausibility.h"
#include "core/landmarks.h"

namespace facewire::filter {

// The one-euro filter (G. Casiez, N. Roussel, D. Vogel, CHI 2012): a low-pass whose cut-off rises
// with speed.
//   cut-off = min_cutoff + beta * max(0, |speed| - speed_floor)
// Speed is in face sizes per second, so that one setting serves every distance to the camera.
struct OneEuroConfig {
  // > 0. Lower = less jitter in a still face, more lag at the start of a motion.
  float min_cutoff_hz;
  // >= 0. Raises the cut-off with speed: less lag.
  float beta;
  // > 0. Smoothing of the speed itself: higher = quicker to notice a motion.
  float derivative_cutoff_hz;
  // >= 0. What is slower counts as jitter. Speed is measured against the filtered point, so a slow
  // motion is not lost: its lag counts as speed. The lag it may keep is about
  // speed_floor x frame time x face size.
  float speed_floor;
};

struct FilterConfig {
  // Lids and irises: a blink is over in 3 to 5 frames.
  OneEuroConfig eyes{0.1F, 120.0F, 5.0F, 0.03F};
  // Lips.
  OneEuroConfig mouth{0.1F, 120.0F, 3.0F, 0.02F};
  OneEuroConfig rest{0.1F, 80.0F, 2.0F, 0.015F};
  PlausibilityConfig plausibility{};
  // A face that seems to have jumped is believed after so many measurements in a row that agree
  // with each other; >= 1 (1 = believed at once).
  int believe_after = 3;
  // After a longer silence the past is forgotten; > 0.
  Duration max_gap = std::chrono::milliseconds(500);
};
// kOutOfRange: a number outside its range above, or not finite.
Result<> Validate(const FilterConfig& config) noexcept;

// Takes the jitter out of landmarks and catches failed tracking.
class LandmarkFilter {
 public:
  // The configuration must be valid.
  explicit LandmarkFilter(const FilterConfig& config) noexcept;
  // Forgets the past; the next landmarks pass unfiltered.
  void Reset() noexcept;
  // The smoothed landmarks, with everything but the points as in `in`.
  //
  // Unchanged are the first ones after Reset, after a gap, after time went backwards, and of
  // another count or picture size. At the time of the last ones the last result comes again: the
  // same instant has one answer.
  //
  // kRejected: the measurement cannot be right (jump, collapse, presence); the caller treats the
  // face as lost. The past is kept until max_gap, so that one bad frame costs one frame. A face
  // that really is elsewhere is taken, from there and unfiltered, at its believe_after'th
  // measurement.
  Result<Landmarks> Update(const Landmarks& in) noexcept;

 private:
  struct PointState {
    std::array<float, 3> value_px{};
    std::array<float, 3> speed{};  // smoothed, face sizes per second
  };
  bool Continues(const Landmarks& in) const noexcept;
  bool Believes(const Extent& face) noexcept;
  void Start(const Landmarks& in) noexcept;
  void Smooth(const Landmarks& in, float step_s, float size_px) noexcept;
  Landmarks Answer(const Landmarks& in) const noexcept;

  FilterConfig config_;
  std::array<PointState, kMaxLandmarks> points_{};
  std::optional<Extent> last_;       // of the last accepted measurement; none = no past
  std::optional<Extent> elsewhere_;  // of the last one that jumped
  int agreeing_ = 0;                 // measurements in a row at `elsewhere_`
  std::size_t count_ = 0;
  int width_px_ = 0;
  int height_px_ = 0;
};

}  // namespace facewire::filter

#endif  // FACEWIRE_CORE_FILTER_LANDMARK_FILTER_H_
