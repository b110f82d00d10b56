#ifndef FACEWIRE_CORE_RETARGET_GEOMETRY_MAPPING_H_
#define FACEWIRE_CORE_RETARGET_GEOMETRY_MAPPING_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/geometry.h"
#include "core/base/result.h"
#include "core/rbf/rbf.h"
#include "core/retarget/alignment.h"

namespace facewire::retarget {

// The paper's geometry mapping: a deformation of space, three functions of three variables, that
// takes one face's neutral points to another's. Motion is mapped as f(point) - f(neutral point), so
// a neutral face gives exactly no motion, whatever the smoothing.
//
// f = alignment + RBF of what the alignment leaves over. The kernel's radius is 1 cm: about the
// width of a lid or a lip, so that a lid that travels to the other lid's place lands on the other
// lid of the target, while a radius near the points' mean distance overshoots between them.
// Smoothing keeps points that nearly touch in neutral (the lips) from tearing space apart.
class GeometryMapping {
 public:
  static std::size_t RequiredBytes(std::size_t max_points) noexcept;
  static std::size_t WorkspaceBytes(std::size_t max_points) noexcept;

  // kFull: the arena is too small.
  Result<> Reserve(std::size_t max_points, Arena& arena) noexcept;

  // Source point i corresponds to target point i, cm; `landmarks` as in Align, whose errors these
  // are too. kFull: more points than reserved. Load time: O(points^3), about 1 ms for 100 points.
  Result<> Solve(std::span<const Point3> source, std::span<const Point3> target,
                 std::span<const std::int16_t> landmarks, std::span<std::byte> workspace) noexcept;

  // f(p), in the target's space, cm. Only after Solve. Not reentrant.
  Point3 Map(Point3 p) const noexcept;

 private:
  Alignment alignment_;
  rbf::Rbf residual_;
  std::span<float> samples_, targets_;  // 3 per point, for Solve
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_GEOMETRY_MAPPING_H_
