#include "tools/facewire/rig/import_bones.h"

namespace facewire::tools::rig {
namespace {

// Ranges and speeds are those of app/share/otto.toml, whose comments say why.
std::vector<PlannedAxis> HeadAxes(double share) {
  return {{"pitch", -30 * share, 30 * share, 120, 900, false, {{"head.pitch", share}}},
          {"yaw", -60 * share, 60 * share, 180, 1200, false, {{"head.yaw", share}}},
          {"roll", -25 * share, 25 * share, 120, 900, false, {{"head.roll", share}}}};
}

std::vector<PlannedAxis> EyeAxes(Side side) {
  const bool left = side == Side::kLeft;
  const std::string name = left ? "Left" : "Right";
  // Yaw turns to the character's own left, which is outwards for the left eye.
  const double out = left ? 28 : -28;
  return {{"pitch",
           -22,
           25,
           700,
           20000,
           false,
           {{"eyeLookDown" + name, 25}, {"eyeLookUp" + name, -22}}},
          {"yaw",
           -30,
           30,
           700,
           20000,
           false,
           {{"eyeLookOut" + name, out}, {"eyeLookIn" + name, -out}}}};
}

std::vector<PlannedAxis> TurningLid(const BoneRole& role) {
  const std::string name = role.side == Side::kLeft ? "Left" : "Right";
  if (role.kind == BoneKind::kUpperLid)
    return {{"pitch",
             -12,
             45,
             1300,
             40000,
             true,
             {{"eyeBlink" + name, 45}, {"eyeWide" + name, -12}, {"eyeLookDown" + name, 10}}}};
  return {
      {"pitch", -20, 5, 600, 20000, true, {{"eyeBlink" + name, -10}, {"eyeSquint" + name, -16}}}};
}

// An offset that follows the bone's landmark.
PlannedAxis Follow(const char* axis, double min, double max, double scale) {
  return {axis, min * scale, max * scale, 30 * scale, 500 * scale, false, {}};
}

std::vector<PlannedAxis> SkinAxes(std::string_view place, double scale) {
  const auto at = [&](std::string_view what) { return place.find(what) != std::string_view::npos; };
  if (at("brow_inner")) return {Follow("x", -0.8, 0.8, scale), Follow("y", -1.2, 1.5, scale)};
  if (at("brow")) return {Follow("y", -1, 1.5, scale)};
  if (at("mouth_corner"))
    return {Follow("x", -1.6, 1.6, scale), Follow("y", -1.6, 1.6, scale),
            Follow("z", -1.2, 1.2, scale)};
  if (at("upper_lip")) return {Follow("y", -1, 1, scale), Follow("z", -1, 1, scale)};
  if (at("lower_lip")) return {Follow("y", -2.5, 1, scale), Follow("z", -1.2, 1, scale)};
  if (at("chin") || at("jaw")) return {Follow("x", -1, 1, scale), Follow("y", -4, 0.5, scale)};
  if (at("upper_lid")) {
    PlannedAxis lid = Follow("y", -1.2, 0.4, scale);
    lid.max_speed = 20 * scale;
    lid.max_acceleration = 1000 * scale;
    lid.hard = true;
    return {lid};
  }
  if (at("lower_lid")) return {Follow("y", -0.3, 0.5, scale)};
  return {Follow("y", -1, 1, scale), Follow("z", -1, 1, scale)};
}

}  // namespace

std::vector<PlannedAxis> AxesOf(const BoneRole& role, std::string_view place, double scale,
                                bool turns, double share) {
  switch (role.kind) {
    case BoneKind::kHead:
    case BoneKind::kNeck:
      return HeadAxes(share);
    case BoneKind::kJaw:
      return {{"pitch", -2, 24, 250, 4000, false, {{"jawOpen", 22}}}};
    case BoneKind::kEye:
      return EyeAxes(role.side);
    case BoneKind::kUpperLid:
    case BoneKind::kLowerLid:
      return turns ? TurningLid(role) : SkinAxes(role.landmark, scale);
    case BoneKind::kSkin:
      break;
  }
  return SkinAxes(place, scale);
}

}  // namespace facewire::tools::rig
