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
// f = alignment + RBF of what the alignment leaves over. The README says how the radius, the
// smoothing and the tail were chosen, and with which figures.
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

  // Where a point is in neutral, in both spaces, cm.
  struct Anchor {
    Point3 source, target;
  };
  // The anchor of a point of the source space. Only after Solve. Not reentrant, as Motion.
  Anchor AnchorAt(Point3 neutral) const noexcept { return {neutral, Map(neutral)}; }

  // How far from its anchor the point is in the target's space when it is at `p` in the source's,
  // cm. Never more than kMaxStretch times as far as the alignment alone would take it, and never
  // against that direction: where f stretches more or folds, its samples contradict each other
  // (touching lips of which the target's stand apart, bones in the wrong order) and it says nothing
  // about motion. Not finite when `p` is not, or is too far away for a float.
  static constexpr float kMaxStretch = 4;
  Point3 Motion(const Anchor& anchor, Point3 p) const noexcept;

 private:
  Point3 Map(Point3 p) const noexcept;  // f

  Alignment alignment_;
  rbf::Rbf residual_;
  std::span<float> samples_, targets_;  // 3 per point, for Solve
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_GEOMETRY_MAPPING_H_
