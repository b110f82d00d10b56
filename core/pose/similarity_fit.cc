#include "core/pose/similarity_fit.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace facewire::pose {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Relative to the whole, what a further turn about the loosest axis would cost. Below this the axis
// is free: many rotations fit. A real face is four orders of magnitude away from it.
constexpr double kFreeAxis = 1e-5;

Vector3d ToVector(Point3 p) noexcept { return {p.x, p.y, p.z}; }

Point3 ToPoint(const Vector3d& v) noexcept {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Matrix3 ToRows(const Matrix3d& m) noexcept {
  Matrix3 rows;
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(rows.data()) = m.cast<float>();
  return rows;
}

}  // namespace

Result<Similarity> FitSimilarity(std::span<const PointPair> pairs) noexcept {
  double total = 0;
  Vector3d from_centre = Vector3d::Zero();
  Vector3d to_centre = Vector3d::Zero();
  for (const PointPair& pair : pairs) {
    total += pair.weight;
    from_centre += pair.weight * ToVector(pair.from);
    to_centre += pair.weight * ToVector(pair.to);
  }
  if (total <= 0) return Errc::kSingular;
  from_centre /= total;
  to_centre /= total;

  Matrix3d covariance = Matrix3d::Zero();  // sum of weight * from * to^T
  double from_spread = 0;
  double to_spread = 0;
  for (const PointPair& pair : pairs) {
    const Vector3d from = ToVector(pair.from) - from_centre;
    const Vector3d to = ToVector(pair.to) - to_centre;
    covariance += pair.weight * from * to.transpose();
    from_spread += pair.weight * from.squaredNorm();
    to_spread += pair.weight * to.squaredNorm();
  }

  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) return Errc::kSingular;  // not finite
  const Matrix3d& u = svd.matrixU();
  const Matrix3d& v = svd.matrixV();
  // The last axis is turned over where the best orthogonal matrix would be a reflection.
  const double hand = u.determinant() * v.determinant() < 0 ? -1 : 1;
  const Vector3d gain = svd.singularValues().cwiseProduct(Vector3d(1, 1, hand));
  const double along = gain.sum();  // sum of weight * to . (rotation * from)
  if (!(2 * (gain[1] + gain[2]) > kFreeAxis * along)) return Errc::kSingular;

  Similarity fit;
  fit.scale = static_cast<float>(along / from_spread);
  fit.rotation = ToRows(v * Vector3d(1, 1, hand).asDiagonal() * u.transpose());
  fit.from_centre = ToPoint(from_centre);
  fit.to_centre = ToPoint(to_centre);
  fit.misfit =
      static_cast<float>(std::sqrt(std::max(0.0, 1 - along * along / (from_spread * to_spread))));
  return fit;
}

}  // namespace facewire::pose
