#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_SHAPE_NAMES_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_SHAPE_NAMES_H_

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/facewire/rig/part_name.h"

namespace facewire::tools::rig {

// ARKit's blend shapes, by the part of the face that they belong to. The default profile gives
// every one of them as a signal but tongueOut, which landmarks do not show.
inline constexpr std::array<std::string_view, 52> kArkitShapes = {
    "eyeBlinkLeft",     "eyeBlinkRight",     "eyeLookUpLeft",      "eyeLookUpRight",
    "eyeLookDownLeft",  "eyeLookDownRight",  "eyeLookInLeft",      "eyeLookInRight",
    "eyeLookOutLeft",   "eyeLookOutRight",   "eyeWideLeft",        "eyeWideRight",
    "eyeSquintLeft",    "eyeSquintRight",    "browInnerUp",        "browDownLeft",
    "browDownRight",    "browOuterUpLeft",   "browOuterUpRight",   "jawOpen",
    "jawForward",       "jawLeft",           "jawRight",           "mouthClose",
    "mouthFunnel",      "mouthPucker",       "mouthLeft",          "mouthRight",
    "mouthSmileLeft",   "mouthSmileRight",   "mouthFrownLeft",     "mouthFrownRight",
    "mouthDimpleLeft",  "mouthDimpleRight",  "mouthStretchLeft",   "mouthStretchRight",
    "mouthRollLower",   "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",
    "mouthPressLeft",   "mouthPressRight",   "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthUpperUpLeft", "mouthUpperUpRight", "cheekPuff",          "cheekSquintLeft",
    "cheekSquintRight", "noseSneerLeft",     "noseSneerRight",     "tongueOut",
};
inline constexpr std::string_view kUnseenShape = "tongueOut";

// How sure a match is; a better one takes a signal from a worse one.
enum class Match {
  kExact,     // ARKit's own name
  kSpelling,  // ARKit's, written otherwise: eyeBlink_L, EyeBlinkLeft, Face.eye_blink_l
  kSynonym,   // a usual other name of the same motion
  kCombined,  // one shape for what ARKit has several of, or the other way round; VRM's presets
  kEmotion,   // a whole expression
};
const char* Describe(Match match);

struct SignalShare {
  std::string signal;  // of the default profile
  double gain = 1;
  Side half = Side::kNone;  // the shape is one side of a signal that has none
};

// What moves a shape.
struct ShapeMatch {
  Match match = Match::kExact;
  std::vector<SignalShare> signals;
  std::size_t order = 0;  // of the first signal in kArkitShapes
};

// By the name of a morph target or VRM expression; nullopt when it says nothing.
std::optional<ShapeMatch> MatchShape(std::string_view name);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_SHAPE_NAMES_H_
