#ifndef FACEWIRE_TOOLS_GLTF_FACE_SHAPE_H_
#define FACEWIRE_TOOLS_GLTF_FACE_SHAPE_H_

#include "core/base/geometry.h"

// Where the mask has its features; what face_mesh.cc builds and face_shape.cc moves. Centimetres in
// the head frame.
namespace facewire::tools {

inline constexpr float kLidLine = 2.62F;  // height where the lids meet
inline constexpr float kEyeX = 3.2F;      // of the middle of the left eye
inline constexpr float kEyeHalfWidth = 1.36F;
inline constexpr float kUpperLidOpen = 0.58F;  // how far an open lid is from the line
inline constexpr float kLowerLidOpen = 0.26F;
inline constexpr float kLipLine = -4.3F;  // height where the lips meet
inline constexpr float kMouthHalfWidth = 2.45F;

constexpr Point3 EyeCentre(int eye) {
  return {static_cast<float>(eye) * kEyeX, kLidLine + 0.15F, 2.25F};
}

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_GLTF_FACE_SHAPE_H_
