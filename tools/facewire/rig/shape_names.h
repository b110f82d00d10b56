#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_SHAPE_NAMES_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_SHAPE_NAMES_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/facewire/rig/part_name.h"

namespace facewire::tools::rig {

// ARKit's blend shapes, by the part of the face that they belong to (tools/names/shapes.json). The
// default profile gives every one of them as a signal but UnseenShape(), which landmarks do not
// show.
const std::vector<std::string>& ArkitShapes();
const std::string& UnseenShape();

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
  std::size_t order = 0;  // of the first signal in ArkitShapes()
};

// By the name of a morph target or VRM expression; nullopt when it says nothing.
std::optional<ShapeMatch> MatchShape(std::string_view name);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_SHAPE_NAMES_H_
