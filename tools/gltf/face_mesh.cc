#include "tools/gltf/face_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "tools/gltf/face_shape.h"

namespace facewire::tools {
namespace {

// The mask is a grid, bent over a head. The rows at the lids' and the lips' lines exist twice
// where these can open: the one belongs to what is above, the other to what is below. Centimetres.
constexpr std::array kHalfColumns{0.0F, 0.6F, 1.2F,  1.85F, 2.4F, 2.8F, 3.2F,
                                  3.6F, 4.0F, 4.55F, 5.2F,  5.9F, 6.6F, 7.2F};
constexpr std::array kRows{9.0F,  8.0F,  7.0F,     6.2F,  5.55F,  5.0F,     4.4F,   3.8F,
                           3.3F,  2.95F, kLidLine, 2.35F, 2.0F,   1.4F,     0.6F,   -0.4F,
                           -1.4F, -2.1F, -2.8F,    -3.3F, -3.75F, kLipLine, -4.85F, -5.3F,
                           -6.0F, -7.0F, -8.0F,    -8.9F, -9.6F};
constexpr std::size_t kColumns = 2 * kHalfColumns.size() - 1;

constexpr float kEyeballRadius = 1.2F;

float Bump(float x, float y, float rx, float ry) {
  return std::exp(-(x * x) / (rx * rx) - (y * y) / (ry * ry));
}

float ColumnX(std::size_t column) {
  const std::size_t middle = kHalfColumns.size() - 1;
  return column < middle ? -kHalfColumns[middle - column] : kHalfColumns[column - middle];
}

// Half the width of the face at a height.
float HalfWidth(float y) {
  const float part = std::min(0.999F, std::abs(y + 0.3F) / 10.4F);
  return 7.3F * std::pow(1 - std::pow(part, 2.3F), 1 / 2.3F);
}

float Depth(float x, float y) {
  const float ellipsoid =
      -2.2F + 7.6F * std::sqrt(std::max(0.0F, 1 - x * x / (7.9F * 7.9F) - y * y / (14.0F * 14.0F)));
  const float ax = std::abs(x);
  return ellipsoid + 2.1F * Bump(x, y + 1.9F, 0.95F, 1.1F) + 1.1F * Bump(x, y - 0.6F, 0.75F, 2.0F) +
         0.6F * Bump(x, y - kLipLine, 2.0F, 0.9F) + 0.8F * Bump(x, y + 8.4F, 1.7F, 1.2F) +
         0.5F * Bump(ax - 3.2F, y - 4.9F, 2.2F, 0.8F) -
         0.7F * Bump(ax - kEyeX, y - kLidLine, 1.9F, 1.3F);
}

// 1 in the middle of an opening, 0 at its ends and beyond.
float Opening(float from_middle, float half_width) {
  const float part = from_middle / half_width;
  return std::max(0.0F, 1 - part * part);
}

enum class Side { kBoth, kUpper, kLower };  // of a line that can open

FacePoint SkinPoint(std::size_t row, std::size_t column, Side side) {
  const float y = kRows[row];
  const float x = ColumnX(column) * HalfWidth(y) / kHalfColumns.back();
  FacePoint point;
  point.rest_cm = {x, y, Depth(x, y)};
  // An open eye is a closed one, pulled apart: what closes it again closes it exactly.
  const float opening = Opening(std::abs(x) - kEyeX, kEyeHalfWidth);
  const float away = std::exp(-(y - kLidLine) * (y - kLidLine) / (0.6F * 0.6F));
  const bool above = y > kLidLine || (y == kLidLine && side != Side::kLower);
  point.lid_cm = opening * away * (above ? kUpperLidOpen : -kLowerLidOpen);
  point.rest_cm.y += point.lid_cm;
  // Lips are full in the middle and thin at the corners.
  const float corner = Bump(std::abs(x) - kMouthHalfWidth, y - kLipLine, 0.9F, 1.0F);
  point.rest_cm.y += (kLipLine - y) * std::min(1.0F, 0.9F * corner);
  point.below_mouth = y < kLipLine ? 1.0F : 0.0F;
  if (y == kLipLine) point.below_mouth = side == Side::kBoth ? 0.5F : side == Side::kLower;
  return point;
}

// The grid with the doubled rows: index of the point of a cell's corner, seen from above or below.
class Skin {
 public:
  Skin() {
    for (std::size_t row = 0; row < kRows.size(); ++row)
      for (std::size_t column = 0; column < kColumns; ++column) AddCorner(row, column);
    for (std::size_t row = 0; row + 1 < kRows.size(); ++row)
      for (std::size_t column = 0; column + 1 < kColumns; ++column) AddNormals(row, column);
    for (FacePoint& p : points_) p.normal = Unit(p.normal);
  }

  // Two triangles of a cell whose upper left corner (picture of the face) is row, column.
  std::array<std::size_t, 6> Cell(std::size_t row, std::size_t column) const {
    const auto top = [&](std::size_t c) { return below_[row * kColumns + c]; };
    const auto bottom = [&](std::size_t c) { return above_[(row + 1) * kColumns + c]; };
    return {top(column), bottom(column),     bottom(column + 1),
            top(column), bottom(column + 1), top(column + 1)};
  }

  const FacePoint& point(std::size_t index) const { return points_[index]; }

 private:
  static Point3 Unit(Point3 v) { return (1 / std::sqrt(Dot(v, v))) * v; }

  void AddCorner(std::size_t row, std::size_t column) {
    const float x = std::abs(ColumnX(column));
    const bool opens = (kRows[row] == kLidLine && Opening(x - kEyeX, kEyeHalfWidth) > 0) ||
                       (kRows[row] == kLipLine && Opening(x, kMouthHalfWidth) > 0);
    above_.push_back(points_.size());
    points_.push_back(SkinPoint(row, column, opens ? Side::kUpper : Side::kBoth));
    below_.push_back(opens ? points_.size() : above_.back());
    if (opens) points_.push_back(SkinPoint(row, column, Side::kLower));
  }

  void AddNormals(std::size_t row, std::size_t column) {
    const auto cell = Cell(row, column);
    for (std::size_t t = 0; t < cell.size(); t += 3) {
      const Point3 u = points_[cell[t + 1]].rest_cm - points_[cell[t]].rest_cm;
      const Point3 v = points_[cell[t + 2]].rest_cm - points_[cell[t]].rest_cm;
      const Point3 area{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
      for (std::size_t i = 0; i < 3; ++i)
        points_[cell[t + i]].normal = points_[cell[t + i]].normal + area;
    }
  }

  std::vector<FacePoint> points_;
  // For every crossing of the grid: the point that the cells above it use, and those below.
  std::vector<std::size_t> above_, below_;
};

FaceMaterial MaterialOf(std::size_t row, std::size_t column) {
  const float x = std::abs(ColumnX(column) + ColumnX(column + 1)) / 2;
  const float y = (kRows[row] + kRows[row + 1]) / 2;
  if (x < kMouthHalfWidth && y < -3.75F && y > -4.85F) return FaceMaterial::kLip;
  if (x > 1.2F && x < 5.2F && y < 5.55F && y > 5.0F) return FaceMaterial::kBrow;
  return FaceMaterial::kSkin;
}

void AddSkin(std::vector<FacePart>& parts) {
  const Skin skin;
  std::array<std::map<std::size_t, std::uint16_t>, kFaceMaterials> taken;
  for (std::size_t row = 0; row + 1 < kRows.size(); ++row) {
    for (std::size_t column = 0; column + 1 < kColumns; ++column) {
      const auto material = static_cast<std::size_t>(MaterialOf(row, column));
      FacePart& part = parts[material];
      for (const std::size_t corner : skin.Cell(row, column)) {
        const auto [at, is_new] =
            taken[material].try_emplace(corner, static_cast<std::uint16_t>(part.points.size()));
        if (is_new) part.points.push_back(skin.point(corner));
        part.triangles.push_back(at->second);
      }
    }
  }
}

// The front of an eyeball between two angles from where it looks.
void AddEyeball(int eye, float from_deg, float to_deg, FacePart& part) {
  constexpr std::size_t kSegments = 16;
  constexpr std::size_t kRings = 4;
  const auto first = part.points.size();
  for (std::size_t ring = 0; ring <= kRings; ++ring) {
    const float polar = (from_deg + (to_deg - from_deg) * static_cast<float>(ring) / kRings) *
                        std::numbers::pi_v<float> / 180;
    for (std::size_t s = 0; s < kSegments; ++s) {
      const float around = 2 * std::numbers::pi_v<float> * static_cast<float>(s) / kSegments;
      FacePoint point;
      point.normal = {std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                      std::cos(polar)};
      point.eye = eye;
      point.rest_cm = EyeCentre(eye) + kEyeballRadius * point.normal;
      part.points.push_back(point);
      if (ring == kRings) continue;
      const auto at = [&](std::size_t r, std::size_t segment) {
        return static_cast<std::uint16_t>(first + r * kSegments + segment % kSegments);
      };
      for (const auto index : {at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)})
        part.triangles.push_back(index);
      // At the pole, the ring of no size, the other triangle of the cell would have no area.
      if (ring == 0 && from_deg == 0) continue;
      for (const auto index : {at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)})
        part.triangles.push_back(index);
    }
  }
}

// What is dark behind the lips.
void AddMouth(FacePart& part) {
  constexpr float kBehind = 2.2F;
  for (const auto& [x, y] : {std::pair{-3.6F, -9.0F}, {3.6F, -9.0F}, {3.6F, -3.0F}, {-3.6F, -3.0F}})
    part.points.push_back({{x, y, kBehind}, {0, 0, 1}});
  part.triangles = {0, 1, 2, 0, 2, 3};
}

}  // namespace

std::vector<FacePart> MakeFaceMesh() {
  std::vector<FacePart> parts(kFaceMaterials);
  for (std::size_t m = 0; m < parts.size(); ++m) parts[m].material = static_cast<FaceMaterial>(m);
  AddSkin(parts);
  constexpr float kIrisDeg = 27;
  for (const int eye : {-1, 1}) {
    AddEyeball(eye, 0, kIrisDeg, parts[static_cast<std::size_t>(FaceMaterial::kIris)]);
    AddEyeball(eye, kIrisDeg, 100, parts[static_cast<std::size_t>(FaceMaterial::kEye)]);
  }
  AddMouth(parts[static_cast<std::size_t>(FaceMaterial::kMouth)]);
  return parts;
}

}  // namespace facewire::tools
