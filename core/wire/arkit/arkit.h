#ifndef FACEWIRE_CORE_WIRE_ARKIT_ARKIT_H_
#define FACEWIRE_CORE_WIRE_ARKIT_ARKIT_H_

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <string_view>

#include "core/face_pose.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"

// A face in the terms that display hosts share: Apple's 52 blend shapes, and how head and eyes
// turn.
namespace facewire::wire::arkit {

inline constexpr std::size_t kShapes = 52;

// As Live Link Face numbers them. Names as Apple writes them.
inline constexpr std::array<std::string_view, kShapes> kShapeNames = {
    "eyeBlinkLeft",      "eyeLookDownLeft",    "eyeLookInLeft",
    "eyeLookOutLeft",    "eyeLookUpLeft",      "eyeSquintLeft",
    "eyeWideLeft",       "eyeBlinkRight",      "eyeLookDownRight",
    "eyeLookInRight",    "eyeLookOutRight",    "eyeLookUpRight",
    "eyeSquintRight",    "eyeWideRight",       "jawForward",
    "jawLeft",           "jawRight",           "jawOpen",
    "mouthClose",        "mouthFunnel",        "mouthPucker",
    "mouthLeft",         "mouthRight",         "mouthSmileLeft",
    "mouthSmileRight",   "mouthFrownLeft",     "mouthFrownRight",
    "mouthDimpleLeft",   "mouthDimpleRight",   "mouthStretchLeft",
    "mouthStretchRight", "mouthRollLower",     "mouthRollUpper",
    "mouthShrugLower",   "mouthShrugUpper",    "mouthPressLeft",
    "mouthPressRight",   "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthUpperUpLeft",  "mouthUpperUpRight",  "browDownLeft",
    "browDownRight",     "browInnerUp",        "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",
    "cheekSquintRight",  "noseSneerLeft",      "noseSneerRight",
    "tongueOut"};

// Its number; nullopt for another name. Case and separators do not matter, and _L and _R stand for
// Left and Right: "mouthSmile_L", "MouthSmileLeft" and "mouthSmileLeft" are one shape.
std::optional<std::size_t> FindShape(std::string_view name) noexcept;

// Left and right are the performer's own. Angles are those of the rig: degrees, from rest, positive
// pitch nods or looks down, positive yaw turns to the own left, positive roll tilts to the own
// right.
struct Face {
  std::array<float, kShapes> shapes{};  // 0..1
  HeadAngles neck, head;                // each bone against the one below it
  HeadAngles left_eye, right_eye;
};

// Neck and head together, Ry(yaw) Rx(pitch) Rz(roll), for a protocol that knows one of them.
HeadAngles HeadOf(const Face& face) noexcept;

// Where a face's values are in the poses of one rig. Made once for a rig description.
class FaceMap {
 public:
  // Parameters by their names, FindShape. Bones "neck", "head", "eye_L" or "leftEye", "eye_R" or
  // "rightEye", in any case and with any separators, by their channels of rotation.
  explicit FaceMap(const Rig& rig) noexcept;

  // What the rig lacks is 0. A shape whose range ends above 1 (per cent, say) is scaled: neutral
  // is 0, max is 1.
  Face FaceOf(const RigPose& pose) const noexcept;

  bool HasShape(std::size_t shape) const noexcept { return shapes_[shape].channel >= 0; }
  bool HasHead() const noexcept { return Any(neck_) || Any(head_); }
  bool HasLeftEye() const noexcept { return Any(left_eye_); }
  bool HasRightEye() const noexcept { return Any(right_eye_); }

 private:
  struct Source {
    int channel = -1;  // of the rig; -1: none
    float zero = 0;    // the channel's value that is 0
    float scale = 1;
    float Of(const RigPose& pose) const noexcept;
  };
  struct Rotation {
    Source pitch, yaw, roll;
    HeadAngles Of(const RigPose& pose) const noexcept;
  };
  static bool Any(const Rotation& r) noexcept {
    return r.pitch.channel >= 0 || r.yaw.channel >= 0 || r.roll.channel >= 0;
  }
  Rotation* RotationOf(std::string_view bone) noexcept;

  std::array<Source, kShapes> shapes_{};
  Rotation neck_, head_, left_eye_, right_eye_;
};

}  // namespace facewire::wire::arkit

#endif  // FACEWIRE_CORE_WIRE_ARKIT_ARKIT_H_
