#ifndef FACEWIRE_CORE_RETARGET_ALIGNMENT_H_
#define FACEWIRE_CORE_RETARGET_ALIGNMENT_H_

#include <cstdint>
#include <span>

#include "core/base/geometry.h"
#include "core/base/result.h"

namespace facewire::retarget {

// Makes two object spaces consistent before the mapping between them is solved (the paper's section
// 5): the scale across comes from the distance between the eyes, the scale up and down from that
// between brows and chin, in depth their geometric mean; the translation takes mean to mean. Axes
// already agree.
struct Alignment {
  Point3 scale{1, 1, 1};
  Point3 source_mean{}, target_mean{};

  Point3 Motion(Point3 d) const noexcept { return {scale.x * d.x, scale.y * d.y, scale.z * d.z}; }
  Point3 operator()(Point3 p) const noexcept { return target_mean + Motion(p - source_mean); }
};

// Point i of `source` corresponds to point i of `target`; `landmarks[i]` is its index in the face
// mesh, or anything negative for a point that has no place in it. A distance that either side
// cannot give (no eye among the points, or a puppet whose eyes coincide), or whose scale is more
// than four times off that of the points' overall spread (a cyclops with its eyes a millimetre
// apart), is replaced by that of the spread. kSingular: several source points, all in one place.
// kInvalidArgument: no points, sizes differ, or values that are not finite.
Result<Alignment> Align(std::span<const Point3> source, std::span<const Point3> target,
                        std::span<const std::int16_t> landmarks) noexcept;

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_ALIGNMENT_H_
