#ifndef FACEWIRE_TOOLS_GLTF_FACE_MESH_H_
#define FACEWIRE_TOOLS_GLTF_FACE_MESH_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/geometry.h"

namespace facewire::tools {

// A point of the mask, in cm and the axes of the head frame (core/face_pose.h).
struct FacePoint {
  Point3 rest_cm;
  Point3 normal;          // of length 1
  float lid_cm = 0;       // how far above the line where the lids meet the open eye holds it
  float below_mouth = 0;  // 0 above the line where the lips meet, 1 below, between beside it
  int eye = 0;            // of an eyeball: 1 the left one, -1 the right one; else 0
};

enum class FaceMaterial { kSkin, kBrow, kLip, kEye, kIris, kMouth };
inline constexpr std::size_t kFaceMaterials = 6;

// What of the mask has one material. Triangles are counter-clockwise seen from outside.
struct FacePart {
  FaceMaterial material = FaceMaterial::kSkin;
  std::vector<FacePoint> points;
  std::vector<std::uint16_t> triangles;  // three indices each
};

// A plain mask with lids, lips, brows and eyes, about as large as a person's face: enough to see
// what blend shapes do. It is made from formulas; no person's or product's face is in it.
std::vector<FacePart> MakeFaceMesh();

// Where a blend shape moves a point at weight 1, cm. Shapes have their ARKit names; one that the
// mask has no movement for (tongueOut, a character's own parameter) leaves it alone.
Point3 Displacement(const FacePoint& point, std::string_view shape);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_GLTF_FACE_MESH_H_
