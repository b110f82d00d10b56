#include "core/pose/similarity_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace facewire::pose {
namespace {

using Vector3d = std::array<double, 3>;
using Matrix3d = std::array<Vector3d, 3>;
using Vector4d = std::array<double, 4>;
using Matrix4d = std::array<Vector4d, 4>;

// Relative to the larger one, two eigenvalues closer than this are the same: the axis between their
// rotations is free. A real face is four orders of magnitude away from it.
constexpr double kSameEigenvalue = 1e-5;

Vector3d Minus(Point3 p, const Vector3d& q) noexcept {
  return {p.x - q[0], p.y - q[1], p.z - q[2]};
}

double SquaredNorm(const Vector3d& v) noexcept { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

// Turns the symmetric matrix diagonal by Jacobi rotations; `vectors` gets the eigenvectors as
// columns. Each sweep roughly squares what is left off the diagonal; ten are plenty for 4x4 in
// double.
void Diagonalise(Matrix4d& m, Matrix4d& vectors) noexcept {
  vectors = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  for (int sweep = 0; sweep < 10; ++sweep) {
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t q = p + 1; q < 4; ++q) {
        if (m[p][q] == 0) continue;
        // The angle that zeroes m[p][q], the smaller of the two, from its tangent.
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::hypot(t, 1.0);
        const double s = t * c;
        for (std::size_t k = 0; k < 4; ++k) {
          const double kp = m[k][p];
          const double kq = m[k][q];
          m[k][p] = c * kp - s * kq;
          m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const double pk = m[p][k];
          const double qk = m[q][k];
          m[p][k] = c * pk - s * qk;
          m[q][k] = s * pk + c * qk;
        }
        for (Vector4d& row : vectors) {
          const double vp = row[p];
          const double vq = row[q];
          row[p] = c * vp - s * vq;
          row[q] = s * vp + c * vq;
        }
      }
    }
  }
}

// Horn's matrix: its largest eigenvalue's vector is the quaternion (w, x, y, z) of the best
// rotation, the eigenvalue itself the sum of weight * to . (rotation * from).
Matrix4d HornMatrix(const Matrix3d& s) noexcept {
  const double xx = s[0][0];
  const double yy = s[1][1];
  const double zz = s[2][2];
  const double a = s[1][2] - s[2][1];
  const double b = s[2][0] - s[0][2];
  const double c = s[0][1] - s[1][0];
  const double d = s[0][1] + s[1][0];
  const double e = s[2][0] + s[0][2];
  const double f = s[1][2] + s[2][1];
  return {{{xx + yy + zz, a, b, c},
           {a, xx - yy - zz, d, e},
           {b, d, yy - xx - zz, f},
           {c, e, f, zz - xx - yy}}};
}

Matrix3 RotationOf(double w, double x, double y, double z) noexcept {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(1 - 2 * (y * y + z * z)), f(2 * (x * y - w * z)),     f(2 * (x * z + w * y)),
          f(2 * (x * y + w * z)),     f(1 - 2 * (x * x + z * z)), f(2 * (y * z - w * x)),
          f(2 * (x * z - w * y)),     f(2 * (y * z + w * x)),     f(1 - 2 * (x * x + y * y))};
}

Point3 ToPoint(const Vector3d& v) noexcept {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace

Result<Similarity> FitSimilarity(std::span<const PointPair> pairs) noexcept {
  double total = 0;
  Vector3d from_centre{};
  Vector3d to_centre{};
  for (const PointPair& pair : pairs) {
    const double w = pair.weight;
    total += w;
    from_centre = {from_centre[0] + w * pair.from.x, from_centre[1] + w * pair.from.y,
                   from_centre[2] + w * pair.from.z};
    to_centre = {to_centre[0] + w * pair.to.x, to_centre[1] + w * pair.to.y,
                 to_centre[2] + w * pair.to.z};
  }
  if (total <= 0) return Errc::kSingular;
  for (double& v : from_centre) v /= total;
  for (double& v : to_centre) v /= total;

  Matrix3d covariance{};  // sum of weight * from * to^T
  double from_spread = 0;
  double to_spread = 0;
  for (const PointPair& pair : pairs) {
    const Vector3d from = Minus(pair.from, from_centre);
    const Vector3d to = Minus(pair.to, to_centre);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) covariance[i][j] += pair.weight * from[i] * to[j];
    }
    from_spread += pair.weight * SquaredNorm(from);
    to_spread += pair.weight * SquaredNorm(to);
  }

  Matrix4d horn = HornMatrix(covariance);
  Matrix4d vectors{};
  Diagonalise(horn, vectors);
  std::size_t best = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if (horn[i][i] > horn[best][best]) best = i;
  }
  const double along = horn[best][best];
  for (std::size_t i = 0; i < 4; ++i) {
    // Written so that NaN, and an `along` of 0 (no extent at all), are singular too.
    if (i != best && !(along - horn[i][i] > kSameEigenvalue * along)) return Errc::kSingular;
  }

  Similarity fit;
  fit.scale = static_cast<float>(along / from_spread);
  fit.rotation = RotationOf(vectors[0][best], vectors[1][best], vectors[2][best], vectors[3][best]);
  fit.from_centre = ToPoint(from_centre);
  fit.to_centre = ToPoint(to_centre);
  fit.misfit =
      static_cast<float>(std::sqrt(std::max(0.0, 1 - along * along / (from_spread * to_spread))));
  return fit;
}

}  // namespace facewire::pose
