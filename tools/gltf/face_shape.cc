#include "tools/gltf/face_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "tools/gltf/face_mesh.h"

namespace facewire::tools {
namespace {

// How a shape spreads over the two halves of the face. Names end in Left or Right but for kBoth.
enum class Halves {
  kBoth,   // the same on both halves
  kOwn,    // only on the half of the name
  kWhole,  // the whole face goes to the side of the name
};
enum class Lips { kAny, kUpper, kLower };  // which side of the mouth's line moves

// The skin around (x, y) goes by (dx, dy, dz), less and less with the distance in units of
// (rx, ry): all for the left half, cm; the right half mirrors it.
struct Push {
  std::string_view shape;  // without Left or Right
  Halves halves;
  Lips lips;
  float x, y, rx, ry;
  float dx, dy, dz;
};

constexpr auto kBoth = Halves::kBoth;
constexpr auto kOwn = Halves::kOwn;
constexpr auto kWhole = Halves::kWhole;
constexpr auto kAny = Lips::kAny;
constexpr auto kUpper = Lips::kUpper;
constexpr auto kLower = Lips::kLower;

constexpr Push kPushes[] = {
    {"browDown", kOwn, kAny, 2.6F, 5.1F, 2.8F, 1.3F, -0.3F, -0.8F, 0.1F},
    {"browInnerUp", kBoth, kAny, 1.2F, 5.3F, 2.0F, 1.8F, 0, 1.1F, 0},
    {"browOuterUp", kOwn, kAny, 4.6F, 5.2F, 1.8F, 1.6F, 0, 1.0F, 0},
    {"cheekPuff", kBoth, kAny, 4.6F, -4.0F, 2.4F, 2.4F, 0.5F, 0, 1.3F},
    {"cheekSquint", kOwn, kAny, 4.2F, 0.2F, 1.8F, 1.6F, 0, 0.7F, 0.4F},
    {"jawForward", kBoth, kLower, 0, -8.0F, 5.0F, 3.6F, 0, 0, 1.2F},
    {"jaw", kWhole, kLower, 0, -8.0F, 6.0F, 3.8F, 1.4F, 0, 0},
    {"jawOpen", kBoth, kLower, 0, -6.6F, 4.6F, 4.6F, 0, -2.6F, -0.4F},
    {"mouthClose", kBoth, kLower, 0, -4.7F, 2.3F, 0.9F, 0, 1.9F, 0.1F},
    {"mouthDimple", kOwn, kAny, 2.6F, -4.3F, 1.3F, 1.3F, 0.4F, 0.1F, -0.5F},
    {"mouthFrown", kOwn, kAny, 2.4F, -4.6F, 1.4F, 1.6F, 0.1F, -0.9F, 0},
    {"mouthFunnel", kBoth, kUpper, 0, -3.9F, 1.8F, 0.9F, 0, 0.4F, 0.9F},
    {"mouthFunnel", kBoth, kLower, 0, -4.7F, 1.8F, 0.9F, 0, -0.5F, 0.9F},
    {"mouthFunnel", kBoth, kAny, 2.4F, -4.3F, 1.3F, 1.4F, -0.8F, 0, 0.4F},
    {"mouth", kWhole, kAny, 0, -4.3F, 3.4F, 1.8F, 1.1F, 0, 0},
    {"mouthLowerDown", kOwn, kLower, 1.2F, -4.8F, 1.6F, 1.3F, 0.1F, -0.7F, 0},
    {"mouthPress", kOwn, kAny, 1.6F, -4.3F, 1.5F, 0.8F, 0, 0, -0.35F},
    {"mouthPucker", kBoth, kAny, 2.4F, -4.3F, 1.7F, 1.6F, -1.2F, 0, 0.5F},
    {"mouthPucker", kBoth, kAny, 0, -4.3F, 1.6F, 1.1F, 0, 0, 1.0F},
    {"mouthRollLower", kBoth, kLower, 0, -4.7F, 2.2F, 0.6F, 0, 0.15F, -0.7F},
    {"mouthRollUpper", kBoth, kUpper, 0, -3.9F, 2.2F, 0.6F, 0, -0.15F, -0.7F},
    {"mouthShrugLower", kBoth, kLower, 0, -5.2F, 2.4F, 1.4F, 0, 0.5F, 0.5F},
    {"mouthShrugUpper", kBoth, kUpper, 0, -3.7F, 2.2F, 1.0F, 0, 0.4F, 0.4F},
    {"mouthSmile", kOwn, kAny, 2.5F, -4.2F, 1.6F, 1.7F, 0.8F, 1.1F, -0.3F},
    {"mouthSmile", kOwn, kAny, 4.0F, -1.2F, 1.6F, 1.8F, 0, 0.4F, 0.4F},
    {"mouthStretch", kOwn, kAny, 2.6F, -4.6F, 1.7F, 1.8F, 1.0F, -0.3F, -0.3F},
    {"mouthUpperUp", kOwn, kUpper, 1.2F, -3.8F, 1.6F, 1.2F, 0.1F, 0.7F, 0},
    {"noseSneer", kOwn, kAny, 1.1F, -1.4F, 1.1F, 1.6F, 0, 0.6F, 0.2F},
};

// What lids do, in parts of how far they are open: -1 shuts the eye.
struct LidMove {
  std::string_view shape;
  float upper, lower;
};
constexpr LidMove kLidMoves[] = {
    {"eyeBlink", -1, -1},          {"eyeSquint", -0.15F, -0.8F}, {"eyeWide", 0.45F, 0.2F},
    {"eyeLookDown", -0.35F, 0.3F}, {"eyeLookUp", 0.2F, -0.2F},
};

// Where eyes look: degrees to the outside of the face, and up.
struct Gaze {
  std::string_view shape;
  float out_deg, up_deg;
};
constexpr Gaze kGazes[] = {
    {"eyeLookOut", 28, 0}, {"eyeLookIn", -28, 0}, {"eyeLookUp", 0, 22}, {"eyeLookDown", 0, -22}};

Point3 Turned(const Gaze& gaze, const FacePoint& point) {
  const float rad = std::numbers::pi_v<float> / 180;
  const float yaw = gaze.out_deg * rad * static_cast<float>(point.eye);
  const float pitch = -gaze.up_deg * rad;
  const Point3 from = point.rest_cm - EyeCentre(point.eye);
  const Point3 nodded{from.x, std::cos(pitch) * from.y - std::sin(pitch) * from.z,
                      std::sin(pitch) * from.y + std::cos(pitch) * from.z};
  const Point3 turned{std::cos(yaw) * nodded.x + std::sin(yaw) * nodded.z, nodded.y,
                      -std::sin(yaw) * nodded.x + std::cos(yaw) * nodded.z};
  return turned - from;
}

float Pull(const Push& push, const FacePoint& point, float x) {
  const float u = (x - push.x) / push.rx;
  const float v = (point.rest_cm.y - push.y) / push.ry;
  const float near = std::exp(-u * u - v * v);
  if (push.lips == kLower) return near * point.below_mouth;
  if (push.lips == kUpper) return near * (1 - point.below_mouth);
  return near;
}

Point3 Pushed(const Push& push, const FacePoint& point, float side) {
  const float x = point.rest_cm.x;
  if (push.halves == kWhole) {
    const float pull = Pull(push, point, x);
    return pull * Point3{side * push.dx, push.dy, push.dz};
  }
  // The middle belongs half to either side, so that the two sides of a shape add up smoothly.
  const auto half = [&](float of) {
    return std::clamp(0.5F + of * x / 1.2F, 0.0F, 1.0F) * Pull(push, point, of * x) *
           Point3{of * push.dx, push.dy, push.dz};
  };
  return push.halves == kBoth ? half(1) + half(-1) : half(side);
}

}  // namespace

Point3 Displacement(const FacePoint& point, std::string_view shape) {
  float side = 0;
  std::string_view base = shape;
  for (const auto& [ending, of] : {std::pair{std::string_view("Left"), 1.0F}, {"Right", -1.0F}}) {
    if (!shape.ends_with(ending)) continue;
    base.remove_suffix(ending.size());
    side = of;
  }
  const auto has_name = [&](const auto& move) { return move.shape == base; };
  Point3 sum;
  if (point.eye != 0) {
    const auto* gaze = std::ranges::find_if(kGazes, has_name);
    return gaze != std::end(kGazes) && side == static_cast<float>(point.eye) ? Turned(*gaze, point)
                                                                             : sum;
  }
  if (side * point.rest_cm.x > 0) {
    if (const auto* lids = std::ranges::find_if(kLidMoves, has_name); lids != std::end(kLidMoves))
      sum.y = point.lid_cm * (point.lid_cm > 0 ? lids->upper : lids->lower);
  }
  for (const Push& push : kPushes) {
    if (push.shape == base && (side != 0) == (push.halves != kBoth))
      sum = sum + Pushed(push, point, side);
  }
  return sum;
}

}  // namespace facewire::tools
