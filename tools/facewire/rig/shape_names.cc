#include "tools/facewire/rig/shape_names.h"

#include <algorithm>

namespace facewire::tools::rig {
namespace {

struct Synonym {
  std::string_view name;   // joined words, without a side
  std::string_view arkit;  // ARKit's, without a side
};

constexpr Synonym kSynonyms[] = {
    {"blink", "eyeblink"},
    {"eyeclose", "eyeblink"},
    {"eyeclosed", "eyeblink"},
    {"eyesclosed", "eyeblink"},
    {"eyesclose", "eyeblink"},
    {"eyesblink", "eyeblink"},
    {"wink", "eyeblink"},
    {"closeeye", "eyeblink"},
    {"closeeyes", "eyeblink"},
    {"fcleyeclose", "eyeblink"},
    {"eyewiden", "eyewide"},
    {"eyeswide", "eyewide"},
    {"eyesurprise", "eyewide"},
    {"fcleyesurprised", "eyewide"},
    {"squint", "eyesquint"},
    {"eyessquint", "eyesquint"},
    {"browinnerraise", "browinnerup"},
    {"innerbrowraise", "browinnerup"},
    {"browsup", "browinnerup"},
    {"browup", "browouterup"},
    {"browraise", "browouterup"},
    {"outerbrowraise", "browouterup"},
    {"browlower", "browdown"},
    {"browlowerer", "browdown"},
    {"browsdown", "browdown"},
    {"browfrown", "browdown"},
    {"eyebrowdown", "browdown"},
    {"eyebrowup", "browouterup"},
    {"mouthopen", "jawopen"},
    {"openmouth", "jawopen"},
    {"jawdrop", "jawopen"},
    {"jawdown", "jawopen"},
    {"mouthclosed", "mouthclose"},
    {"jawthrust", "jawforward"},
    {"smile", "mouthsmile"},
    {"lipcornerpull", "mouthsmile"},
    {"frown", "mouthfrown"},
    {"lipcornerdepress", "mouthfrown"},
    {"mouthsad", "mouthfrown"},
    {"pucker", "mouthpucker"},
    {"kiss", "mouthpucker"},
    {"lippucker", "mouthpucker"},
    {"lipspucker", "mouthpucker"},
    {"funnel", "mouthfunnel"},
    {"lipfunnel", "mouthfunnel"},
    {"dimple", "mouthdimple"},
    {"dimpler", "mouthdimple"},
    {"stretch", "mouthstretch"},
    {"lipstretch", "mouthstretch"},
    {"mouthwide", "mouthstretch"},
    {"lippress", "mouthpress"},
    {"upperlipup", "mouthupperup"},
    {"upperlipraise", "mouthupperup"},
    {"mouthupperlipup", "mouthupperup"},
    {"lowerlipdown", "mouthlowerdown"},
    {"mouthlowerlipdown", "mouthlowerdown"},
    {"lowerlipdepress", "mouthlowerdown"},
    {"puff", "cheekpuff"},
    {"cheekspuff", "cheekpuff"},
    {"cheekraise", "cheeksquint"},
    {"cheekup", "cheeksquint"},
    {"sneer", "nosesneer"},
    {"nosewrinkle", "nosesneer"},
    {"nosewrinkler", "nosesneer"},
    {"tongue", "tongueout"},
    {"stickouttongue", "tongueout"},
};

// VRM's presets, visemes of other makers by what they look like, and whole expressions.
struct Preset {
  std::string_view name;  // joined words, without a side
  Side side;
  Match match;
  std::array<SignalShare, 2> signals;  // the second's name may be empty
};

const Preset kPresets[] = {
    {"aa", Side::kNone, Match::kCombined, {{{"jawOpen", 1}, {}}}},
    {"ih",
     Side::kNone,
     Match::kCombined,
     {{{"mouthLowerDownLeft", 0.5}, {"mouthLowerDownRight", 0.5}}}},
    {"ou", Side::kNone, Match::kCombined, {{{"mouthPucker", 1}, {}}}},
    {"ee",
     Side::kNone,
     Match::kCombined,
     {{{"mouthStretchLeft", 0.5}, {"mouthStretchRight", 0.5}}}},
    {"oh", Side::kNone, Match::kCombined, {{{"mouthFunnel", 1}, {}}}},
    {"lookup", Side::kNone, Match::kCombined, {{{"eyeLookUpLeft", 0.5}, {"eyeLookUpRight", 0.5}}}},
    {"lookdown",
     Side::kNone,
     Match::kCombined,
     {{{"eyeLookDownLeft", 0.5}, {"eyeLookDownRight", 0.5}}}},
    {"look", Side::kLeft, Match::kCombined, {{{"eyeLookOutLeft", 0.5}, {"eyeLookInRight", 0.5}}}},
    {"look", Side::kRight, Match::kCombined, {{{"eyeLookInLeft", 0.5}, {"eyeLookOutRight", 0.5}}}},
    {"happy", Side::kNone, Match::kEmotion, {{{"mouthSmileLeft", 0.5}, {"mouthSmileRight", 0.5}}}},
    {"angry", Side::kNone, Match::kEmotion, {{{"browDownLeft", 0.5}, {"browDownRight", 0.5}}}},
    {"sad", Side::kNone, Match::kEmotion, {{{"mouthFrownLeft", 0.5}, {"mouthFrownRight", 0.5}}}},
    {"surprised", Side::kNone, Match::kEmotion, {{{"eyeWideLeft", 0.5}, {"eyeWideRight", 0.5}}}},
};

constexpr Synonym kPresetSynonyms[] = {
    {"a", "aa"},
    {"i", "ih"},
    {"u", "ou"},
    {"e", "ee"},
    {"o", "oh"},
    {"visemeaa", "aa"},
    {"visemei", "ih"},
    {"visemeu", "ou"},
    {"visemee", "ee"},
    {"visemeo", "oh"},
    {"vaa", "aa"},
    {"vih", "ih"},
    {"vou", "ou"},
    {"voh", "oh"},
    {"vee", "ee"},
    {"fclmtha", "aa"},
    {"fclmthi", "ih"},
    {"fclmthu", "ou"},
    {"fclmthe", "ee"},
    {"fclmtho", "oh"},
    {"joy", "happy"},
    {"sorrow", "sad"},
    {"surprise", "surprised"},
    {"fclalljoy", "happy"},
    {"fclallangry", "angry"},
    {"fclallsorrow", "sad"},
    {"fclallsurprised", "surprised"},
    {"eyeslookup", "lookup"},
    {"eyeslookdown", "lookdown"},
    {"eyeslook", "look"},
};

// Words that say nothing when they stand first.
constexpr std::string_view kFillers[] = {"blendshape", "blendshape1", "bs",     "face",  "head",
                                         "exp",        "expression",  "morph",  "shape", "key",
                                         "ctrl",       "arkit",       "facial", "m",     "f00",
                                         "000",        "00",          "c",      "ghost"};

struct Arkit {
  PartName part;
  std::string joined;
};

const std::array<Arkit, kArkitShapes.size()>& Table() {
  static const auto kTable = [] {
    std::array<Arkit, kArkitShapes.size()> table;
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i].part = TakeApart(kArkitShapes[i]);
      table[i].joined = table[i].part.Joined();
    }
    return table;
  }();
  return kTable;
}

SignalShare ShareOf(std::size_t arkit, double gain, Side half = Side::kNone) {
  return {std::string(kArkitShapes[arkit]), gain, half};
}

// The shape of this name and side; or both sides of it; or one side of a shape that has none.
std::optional<ShapeMatch> FindArkit(std::string_view joined, Side side, Match match) {
  ShapeMatch found{match, {}, kArkitShapes.size()};
  const auto take = [&](std::size_t i, double gain, Side half) {
    found.order = std::min(found.order, i);
    found.signals.push_back(ShareOf(i, gain, half));
  };
  for (std::size_t i = 0; i < Table().size(); ++i) {
    const auto& [part, name] = Table()[i];
    if (name != joined) continue;
    if (part.side == side) {
      take(i, 1, Side::kNone);
      return found;
    }
    // jawLeft and jawRight are opposites, no halves of a jaw.
    const bool opposites = name == "jaw" || name == "mouth";
    if (side == Side::kNone && !opposites) take(i, 0.5, Side::kNone);
    if (part.side == Side::kNone) take(i, 1, side);
  }
  if (found.signals.empty()) return std::nullopt;
  found.match = Match::kCombined;
  return found;
}

std::optional<ShapeMatch> FindPreset(std::string_view joined, Side side) {
  for (const Synonym& synonym : kPresetSynonyms)
    if (synonym.name == joined) joined = synonym.arkit;
  for (const Preset& preset : kPresets) {
    if (preset.name != joined || preset.side != side) continue;
    ShapeMatch found{preset.match, {}, 0};
    for (const SignalShare& share : preset.signals)
      if (!share.signal.empty()) found.signals.push_back(share);
    found.order = static_cast<std::size_t>(
        std::ranges::find(kArkitShapes, found.signals[0].signal) - kArkitShapes.begin());
    return found;
  }
  return std::nullopt;
}

std::optional<ShapeMatch> Find(const PartName& part) {
  const std::string joined = part.Joined();
  if (auto found = FindArkit(joined, part.side, Match::kSpelling)) return found;
  for (const Synonym& synonym : kSynonyms)
    if (synonym.name == joined) return FindArkit(synonym.arkit, part.side, Match::kSynonym);
  return FindPreset(joined, part.side);
}

}  // namespace

const char* Describe(Match match) {
  switch (match) {
    case Match::kExact:
      return "ARKit's name";
    case Match::kSpelling:
      return "ARKit's name, written otherwise";
    case Match::kSynonym:
      return "a synonym";
    case Match::kCombined:
      return "not one for one";
    case Match::kEmotion:
      return "a whole expression";
  }
  return "";
}

std::optional<ShapeMatch> MatchShape(std::string_view name) {
  if (const auto* at = std::ranges::find(kArkitShapes, name); at != kArkitShapes.end()) {
    const auto index = static_cast<std::size_t>(at - kArkitShapes.begin());
    return ShapeMatch{Match::kExact, {ShareOf(index, 1)}, index};
  }
  PartName part = TakeApart(name);
  // VRoid's names begin with the model's: M_F00_000_00_Fcl_EYE_Close_L.
  while (!part.words.empty()) {
    if (auto found = Find(part)) return found;
    if (std::ranges::find(kFillers, part.words.front()) == std::end(kFillers)) break;
    part.words.erase(part.words.begin());
  }
  return std::nullopt;
}

}  // namespace facewire::tools::rig
