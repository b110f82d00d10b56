#ifndef FACEWIRE_CORE_POSE_SIMILARITY_FIT_H_
#define FACEWIRE_CORE_POSE_SIMILARITY_FIT_H_

#include <span>

#include "core/base/geometry.h"
#include "core/base/result.h"

namespace facewire::pose {

// `from` should land on `to`.
struct PointPair {
  Point3 from;
  Point3 to;
  float weight;  // >= 0
};

// to = scale * rotation * (from - from_centre) + to_centre
struct Similarity {
  float scale = 1;                // units of `to` per unit of `from`, > 0
  Matrix3 rotation = kIdentity3;  // orthonormal, determinant +1: never a reflection
  Point3 from_centre{};           // weighted means
  Point3 to_centre{};
  // Weighted RMS distance left, relative to the weighted RMS radius of the `to`s; 0..1.
  float misfit = 0;
};

// The similarity with the least weighted sum of squared distances, after S. Umeyama, "Least-squares
// estimation of transformation parameters between two point patterns", IEEE PAMI 13 (1991). Without
// the heap: Eigen's fixed-size Jacobi SVD refers to none, its eigenvalue solvers do.
// kSingular: more than one rotation fits equally well (fewer than three points, all on one line,
// all weights zero). The points must be finite and below 1e9.
Result<Similarity> FitSimilarity(std::span<const PointPair> pairs) noexcept;

}  // namespace facewire::pose

#endif  // FACEWIRE_CORE_POSE_SIMILARITY_FIT_H_
