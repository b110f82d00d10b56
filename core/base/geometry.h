#ifndef FACEWIRE_CORE_BASE_GEOMETRY_H_
#define FACEWIRE_CORE_BASE_GEOMETRY_H_

#include <array>

namespace facewire {

struct Point3 {
  float x = 0, y = 0, z = 0;
  friend constexpr bool operator==(const Point3&, const Point3&) = default;
};

// A 3x3 matrix by rows.
using Matrix3 = std::array<float, 9>;
inline constexpr Matrix3 kIdentity3 = {1, 0, 0, 0, 1, 0, 0, 0, 1};

constexpr Point3 operator+(Point3 a, Point3 b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Point3 operator-(Point3 a, Point3 b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Point3 operator*(float s, Point3 p) noexcept { return {s * p.x, s * p.y, s * p.z}; }
constexpr float Dot(Point3 a, Point3 b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
// Every coordinate is a number from -limit to limit; false for NaN.
constexpr bool IsWithin(Point3 p, float limit) noexcept {
  return p.x >= -limit && p.x <= limit && p.y >= -limit && p.y <= limit && p.z >= -limit &&
         p.z <= limit;
}
constexpr Point3 operator*(const Matrix3& m, Point3 p) noexcept {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z, m[3] * p.x + m[4] * p.y + m[5] * p.z,
          m[6] * p.x + m[7] * p.y + m[8] * p.z};
}

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_GEOMETRY_H_
