#include <algorithm>
#include <string_view>

#include "tools/sheet/character.h"

namespace facewire::tools {
namespace {

// What of the character a channel moves. Full is how far a channel goes, as a part of its range on
// that side, where the character shows the full expression: bones have a reserve beyond what faces
// do.
struct Source {
  double CharacterPose::*field;
  std::string_view channel;
  double weight;
  double full;
};

constexpr Source kBones[] = {
    {&CharacterPose::jaw, "jaw.pitch", 1, 1},
    {&CharacterPose::lid_left, "upper_lid_L.pitch", 1, 1},
    {&CharacterPose::lid_right, "upper_lid_R.pitch", 1, 1},
    {&CharacterPose::brow_left, "brow_inner_L.y", 0.5, 0.4},
    {&CharacterPose::brow_left, "brow_outer_L.y", 0.5, 0.4},
    {&CharacterPose::brow_right, "brow_inner_R.y", 0.5, 0.4},
    {&CharacterPose::brow_right, "brow_outer_R.y", 0.5, 0.4},
    {&CharacterPose::corner_left_x, "lip_corner_L.x", 1, 0.5},
    {&CharacterPose::corner_right_x, "lip_corner_R.x", -1, 0.5},
    {&CharacterPose::corner_left_y, "lip_corner_L.y", 1, 0.5},
    {&CharacterPose::corner_right_y, "lip_corner_R.y", 1, 0.5},
    {&CharacterPose::gaze_x, "eye_L.yaw", 0.5, 0.7},
    {&CharacterPose::gaze_x, "eye_R.yaw", 0.5, 0.7},
    {&CharacterPose::gaze_y, "eye_L.pitch", -0.5, 0.7},
    {&CharacterPose::gaze_y, "eye_R.pitch", -0.5, 0.7},
};

// For a character that has no such bone, the blend shapes by their ARKit names.
constexpr Source kParameters[] = {
    {&CharacterPose::jaw, "jawOpen", 1, 1},
    {&CharacterPose::lid_left, "eyeBlinkLeft", 1, 1},
    {&CharacterPose::lid_right, "eyeBlinkRight", 1, 1},
    {&CharacterPose::brow_left, "browInnerUp", 1, 1},
    {&CharacterPose::brow_left, "browDownLeft", -1, 1},
    {&CharacterPose::brow_right, "browInnerUp", 1, 1},
    {&CharacterPose::brow_right, "browDownRight", -1, 1},
    {&CharacterPose::corner_left_x, "mouthPucker", -1, 1},
    {&CharacterPose::corner_right_x, "mouthPucker", -1, 1},
    {&CharacterPose::corner_left_y, "mouthSmileLeft", 1, 1},
    {&CharacterPose::corner_left_y, "mouthFrownLeft", -1, 1},
    {&CharacterPose::corner_right_y, "mouthSmileRight", 1, 1},
    {&CharacterPose::corner_right_y, "mouthFrownRight", -1, 1},
    {&CharacterPose::gaze_x, "eyeLookOutLeft", 1, 1},
    {&CharacterPose::gaze_x, "eyeLookInLeft", -1, 1},
    {&CharacterPose::gaze_y, "eyeLookUpLeft", 1, 1},
    {&CharacterPose::gaze_y, "eyeLookDownLeft", -1, 1},
};

// The head itself, in degrees.
constexpr Source kHead[] = {
    {&CharacterPose::pitch_deg, "neck.pitch", 1, 1},
    {&CharacterPose::yaw_deg, "neck.yaw", 1, 1},
    {&CharacterPose::roll_deg, "neck.roll", 1, 1},
};

// -1 .. 1: how far the value is from neutral, in parts of the range on its side.
double Deflection(const Channel& channel, float value, double full) {
  const auto away = static_cast<double>(value - channel.neutral);
  const auto range =
      static_cast<double>(away < 0 ? channel.neutral - channel.min : channel.max - channel.neutral);
  return range > 0 ? std::clamp(away / (range * full), -1.0, 1.0) : 0.0;
}

bool HasBoneFor(const Rig& rig, double CharacterPose::*field) {
  return std::ranges::any_of(kBones, [&](const Source& s) {
    return s.field == field && rig.FindChannel(s.channel).has_value();
  });
}

}  // namespace

CharacterPose CharacterPoseOf(const Rig& rig, const RigPose& pose) {
  CharacterPose character;
  const auto add = [&](const Source& source) {
    const auto index = rig.FindChannel(source.channel);
    if (!index || *index >= pose.count) return;
    character.*source.field +=
        source.weight * Deflection(rig.channels[*index], pose.values[*index], source.full);
  };
  for (const Source& source : kBones) add(source);
  for (const Source& source : kParameters) {
    if (!HasBoneFor(rig, source.field)) add(source);
  }
  for (const Source& source : kHead) {
    const auto index = rig.FindChannel(source.channel);
    if (index && *index < pose.count)
      character.*source.field = static_cast<double>(pose.values[*index]);
  }
  return character;
}

}  // namespace facewire::tools
