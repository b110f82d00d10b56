#ifndef FACEWIRE_TESTS_SUPPORT_GENERATED_MARKERS_H_
#define FACEWIRE_TESTS_SUPPORT_GENERATED_MARKERS_H_

#include <array>
#include <cstddef>

#include "core/base/geometry.h"

namespace facewire::test {

inline constexpr std::size_t kMarkerCount = 68;
using MarkerPoints = std::array<Point3, kMarkerCount>;

// A face of 68 markers made of figures, for tests that need a performance of known shape: in the
// usual order (17 along the jaw from the person's right ear to the left, 10 brows, 9 nose, 6 around
// each eye, 12 around the lips, 8 inside them), at the usual places of an adult, lips nearly
// touching. Axes of FacePose, cm.
MarkerPoints NeutralMarkers();

// The same face `t_s` seconds into a performance that lasts as long as one likes and starts at
// rest: jaw, smile, pucker, brows and blinks come and go in ever new combinations.
MarkerPoints PerformingMarkers(float t_s);

}  // namespace facewire::test

#endif  // FACEWIRE_TESTS_SUPPORT_GENERATED_MARKERS_H_
