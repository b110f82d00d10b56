#include "core/wire/vmc/vmc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facewire::wire::vmc {
namespace {

// Before the shapes come OK, T and four bones; behind them Apply.
constexpr std::size_t kBones = 4;
constexpr std::size_t kBefore = 2 + kBones;

// As the characters made for it name them: ARKit's with a capital. In the order of
// arkit::kShapeNames.
constexpr std::array<std::string_view, arkit::kShapes> kPerfectSync = {
    "EyeBlinkLeft",      "EyeLookDownLeft",    "EyeLookInLeft",
    "EyeLookOutLeft",    "EyeLookUpLeft",      "EyeSquintLeft",
    "EyeWideLeft",       "EyeBlinkRight",      "EyeLookDownRight",
    "EyeLookInRight",    "EyeLookOutRight",    "EyeLookUpRight",
    "EyeSquintRight",    "EyeWideRight",       "JawForward",
    "JawLeft",           "JawRight",           "JawOpen",
    "MouthClose",        "MouthFunnel",        "MouthPucker",
    "MouthLeft",         "MouthRight",         "MouthSmileLeft",
    "MouthSmileRight",   "MouthFrownLeft",     "MouthFrownRight",
    "MouthDimpleLeft",   "MouthDimpleRight",   "MouthStretchLeft",
    "MouthStretchRight", "MouthRollLower",     "MouthRollUpper",
    "MouthShrugLower",   "MouthShrugUpper",    "MouthPressLeft",
    "MouthPressRight",   "MouthLowerDownLeft", "MouthLowerDownRight",
    "MouthUpperUpLeft",  "MouthUpperUpRight",  "BrowDownLeft",
    "BrowDownRight",     "BrowInnerUp",        "BrowOuterUpLeft",
    "BrowOuterUpRight",  "CheekPuff",          "CheekSquintLeft",
    "CheekSquintRight",  "NoseSneerLeft",      "NoseSneerRight",
    "TongueOut"};

float ShapeOf(const arkit::Face& face, std::string_view name) noexcept {
  const auto index = arkit::FindShape(name);
  return index ? face.shapes[*index] : 0;
}

}  // namespace

Quaternion UnityRotation(const HeadAngles& angles) noexcept {
  constexpr float kHalf = std::numbers::pi_v<float> / 360;  // half an angle, from degrees
  const float cp = std::cos(angles.pitch_deg * kHalf), sp = std::sin(angles.pitch_deg * kHalf);
  const float cy = std::cos(angles.yaw_deg * kHalf), sy = std::sin(angles.yaw_deg * kHalf);
  const float cr = std::cos(angles.roll_deg * kHalf), sr = std::sin(angles.roll_deg * kHalf);
  // Ry(yaw) Rx(pitch) Rz(roll) in our axes.
  const Quaternion ours = {.x = cy * sp * cr + sy * cp * sr,
                           .y = sy * cp * cr - cy * sp * sr,
                           .z = cy * cp * sr - sy * sp * cr,
                           .w = cy * cp * cr + sy * sp * sr};
  // Mirrored in x, an axis (x, y, z) of rotation becomes (x, -y, -z).
  return {.x = ours.x, .y = -ours.y, .z = -ours.z, .w = ours.w};
}

Vowels VowelsOf(const arkit::Face& face) noexcept {
  const float open = std::clamp(ShapeOf(face, "jawOpen") - ShapeOf(face, "mouthClose"), 0.0F, 1.0F);
  const float round = std::max(ShapeOf(face, "mouthFunnel"), ShapeOf(face, "mouthPucker"));
  const float wide = (ShapeOf(face, "mouthStretchLeft") + ShapeOf(face, "mouthStretchRight")) / 2;
  const float rest = 1 - round;  // lips are round or wide, never both
  return {.a = open * rest * (1 - wide),
          .i = (1 - open) * rest * wide,
          .u = (1 - open) * round,
          .e = open * rest * wide,
          .o = open * round};
}

FramePackets::FramePackets(Names names, const Frame& frame) noexcept : frame_(frame) {
  if (names == Names::kArkit) {
    for (std::size_t i = 0; i < arkit::kShapes; ++i) Push(kPerfectSync[i], frame.face.shapes[i]);
    return;
  }
  const bool vrm0 = names == Names::kVrm0;
  const Vowels vowels = VowelsOf(frame.face);
  Push(vrm0 ? "Blink_L" : "blinkLeft", ShapeOf(frame.face, "eyeBlinkLeft"));
  Push(vrm0 ? "Blink_R" : "blinkRight", ShapeOf(frame.face, "eyeBlinkRight"));
  Push(vrm0 ? "A" : "aa", vowels.a);
  Push(vrm0 ? "I" : "ih", vowels.i);
  Push(vrm0 ? "U" : "ou", vowels.u);
  Push(vrm0 ? "E" : "ee", vowels.e);
  Push(vrm0 ? "O" : "oh", vowels.o);
}

std::size_t FramePackets::MessageCount() const noexcept { return kBefore + count_ + 1; }

Result<std::span<const std::byte>> FramePackets::Next(std::span<std::byte> out) noexcept {
  if (next_ == MessageCount()) return Errc::kEnd;
  osc::Writer packet(out.first(std::min(out.size(), kMaxPacketBytes)));
  if (const auto begun = packet.Bundle(); !begun) return begun.error();
  const std::size_t first = next_;
  while (next_ < MessageCount()) {
    const auto added = Add(next_, packet);
    if (!added) {
      if (next_ == first) return added.error();
      break;
    }
    ++next_;
  }
  return packet.bytes();
}

Result<> FramePackets::Add(std::size_t index, osc::Writer& packet) const noexcept {
  constexpr std::int32_t kLoaded = 1;
  constexpr std::int32_t kCalibrated = 3;
  constexpr std::int32_t kNormalMode = 0;
  const arkit::Face& face = frame_.face;
  switch (index) {
    case 0:
      return packet.Message("/VMC/Ext/OK", kLoaded, kCalibrated, kNormalMode,
                            std::int32_t{frame_.tracking ? 1 : 0});
    case 1:
      return packet.Message("/VMC/Ext/T", frame_.elapsed_s);
    case 2:
      return AddBone("Neck", face.neck, packet);
    case 3:
      return AddBone("Head", face.head, packet);
    case 4:
      return AddBone("LeftEye", face.left_eye, packet);
    case 5:
      return AddBone("RightEye", face.right_eye, packet);
    default:
      break;
  }
  if (index - kBefore == count_) return packet.Message("/VMC/Ext/Blend/Apply");
  const Shape& shape = shapes_[index - kBefore];
  return packet.Message("/VMC/Ext/Blend/Val", shape.name, shape.value);
}

Result<> FramePackets::AddBone(std::string_view name, const HeadAngles& angles,
                               osc::Writer& packet) const noexcept {
  const Quaternion q = UnityRotation(angles);
  return packet.Message("/VMC/Ext/Bone/Pos", name, 0.0F, 0.0F, 0.0F, q.x, q.y, q.z, q.w);
}

}  // namespace facewire::wire::vmc
