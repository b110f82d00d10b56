#ifndef FACEWIRE_CORE_FILTER_PLAUSIBILITY_H_
#define FACEWIRE_CORE_FILTER_PLAUSIBILITY_H_

#include <optional>

#include "core/base/geometry.h"
#include "core/base/time.h"
#include "core/landmarks.h"

namespace facewire::filter {

// Where a face is in the picture and how big, from its 468 mesh points.
struct Extent {
  Point3 centre_px{};  // their mean; z unused
  float size_px = 0;   // the longer side of their upright bounding box
  Time at{};
};

struct PlausibilityConfig {
  float min_presence = 0.5F;  // 0..1; the tracker's own limit is 0.5 as well
  float min_size_px = 12;     // smaller, a lid moves less than the networks' noise
  // Between two frames. Talking people who turn stayed below 1.1 (measured); a jump to another face
  // is tens.
  float max_speed_sizes_per_s = 12;
  float max_size_ratio = 1.5F;  // bigger or smaller; opening the mouth wide makes 1.25. > 1
};

// nullopt when the landmarks cannot be a face: presence below the limit, count neither 468 nor 478,
// a point that is not finite or beyond 1e6 px, too small, or collapsed (outer eye corners closer
// than 0.15 sizes, forehead and chin closer than 0.3 sizes, depth included; talking, turning faces
// measured at least 0.46 and 0.98).
std::optional<Extent> MeasureFace(const Landmarks& in, const PlausibilityConfig& config) noexcept;

// Whether no head can have moved from `from` to `to` in the time between (at least 1/30 s is
// granted, because timestamps jitter).
bool Jumped(const Extent& from, const Extent& to, const PlausibilityConfig& config) noexcept;

}  // namespace facewire::filter

#endif  // FACEWIRE_CORE_FILTER_PLAUSIBILITY_H_
