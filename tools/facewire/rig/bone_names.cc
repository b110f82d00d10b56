#include "tools/facewire/rig/bone_names.h"

#include <algorithm>
#include <initializer_list>

namespace facewire::tools::rig {
namespace {

bool Any(const PartName& part, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return part.Has(word); });
}

bool Contains(const std::string& joined, std::string_view text) {
  return joined.find(text) != std::string::npos;
}

std::string Sided(Side side, std::string_view landmark) {
  return (side == Side::kLeft ? "left_" : "right_") + std::string(landmark);
}

// Helpers of animators, ends of chains, hair and the like.
bool IsNoFacePart(const PartName& part, const std::string& joined) {
  return Any(part, {"end",    "nub",     "leaf",   "ik",        "target", "pole", "aim",
                    "ctrl",   "control", "goal",   "highlight", "hair",   "ear",  "hat",
                    "twist",  "teeth",   "tongue", "lash",      "lashes", "sec",  "spring",
                    "ribbon", "glasses", "horn",   "beard"}) ||
         Contains(joined, "teeth") || Contains(joined, "tongue") || Contains(joined, "lash") ||
         Contains(joined, "target") || Contains(joined, "hair");
}

enum class Height { kUnknown, kUpper, kLower };

Height HeightOf(const PartName& part, const std::string& joined) {
  if (Any(part, {"up", "top"}) || Contains(joined, "upper")) return Height::kUpper;
  if (Any(part, {"low", "bot", "down"}) || Contains(joined, "lower") || Contains(joined, "bottom"))
    return Height::kLower;
  return Height::kUnknown;
}

std::optional<BoneRole> Mouth(const PartName& part, const std::string& joined, Height height) {
  const bool sided = part.side != Side::kNone;
  if (sided && (Contains(joined, "corner") || height == Height::kUnknown))
    return BoneRole{BoneKind::kSkin, part.side, Sided(part.side, "mouth_corner")};
  if (!sided && height == Height::kUpper) return BoneRole{BoneKind::kSkin, {}, "upper_lip"};
  if (!sided && height == Height::kLower) return BoneRole{BoneKind::kSkin, {}, "lower_lip"};
  return std::nullopt;  // the lips' other bones: by position
}

BoneRole Brow(const PartName& part, const std::string& joined) {
  const std::string_view place = Contains(joined, "inner") || part.Has("in")    ? "brow_inner"
                                 : Contains(joined, "outer") || part.Has("out") ? "brow_outer"
                                                                                : "brow_middle";
  return {BoneKind::kSkin, part.side, Sided(part.side, place)};
}

}  // namespace

std::optional<BoneRole> MatchBone(std::string_view name) {
  const PartName part = TakeApart(name);
  const std::string joined = part.Joined();
  if (IsNoFacePart(part, joined)) return std::nullopt;
  const bool sided = part.side != Side::kNone;
  const Height height = HeightOf(part, joined);
  if (Contains(joined, "brow")) return sided ? std::optional(Brow(part, joined)) : std::nullopt;
  if (Contains(joined, "eyelid") || part.Has("lid")) {
    if (!sided) return std::nullopt;
    if (height == Height::kLower)
      return BoneRole{BoneKind::kLowerLid, part.side, Sided(part.side, "lower_lid")};
    return BoneRole{BoneKind::kUpperLid, part.side, Sided(part.side, "upper_lid")};
  }
  if (sided && (Any(part, {"eye", "eyeball"}) || joined == "faceeye"))
    return BoneRole{BoneKind::kEye, part.side, {}};
  if (Contains(joined, "lip") || Contains(joined, "mouth")) return Mouth(part, joined, height);
  if (!sided && part.Has("chin")) return BoneRole{BoneKind::kSkin, {}, "chin"};
  if (!sided && height != Height::kUpper && (Contains(joined, "jaw") || part.Has("mandible")))
    return BoneRole{BoneKind::kJaw, {}, {}};
  if (sided && Contains(joined, "cheek"))
    return BoneRole{BoneKind::kSkin, part.side, Sided(part.side, "cheek")};
  if (sided && Contains(joined, "nostril"))
    return BoneRole{BoneKind::kSkin, part.side, Sided(part.side, "nostril")};
  if (!sided && part.words.size() <= 2 && part.words.size() > 0) {
    if (part.words.back() == "head") return BoneRole{BoneKind::kHead, {}, {}};
    if (part.words.back() == "neck" || joined == "neck1" || joined == "neck01")
      return BoneRole{BoneKind::kNeck, {}, {}};
  }
  // VRoid: J_Bip_C_Head.
  if (part.Has("bip") && part.Has("head")) return BoneRole{BoneKind::kHead, {}, {}};
  if (part.Has("bip") && part.Has("neck")) return BoneRole{BoneKind::kNeck, {}, {}};
  return std::nullopt;
}

bool IsHelper(std::string_view name) {
  const PartName part = TakeApart(name);
  return IsNoFacePart(part, part.Joined());
}

std::optional<BoneRole> MatchHumanoid(std::string_view name) {
  if (name == "head") return BoneRole{BoneKind::kHead, {}, {}};
  if (name == "neck") return BoneRole{BoneKind::kNeck, {}, {}};
  if (name == "jaw") return BoneRole{BoneKind::kJaw, {}, {}};
  if (name == "leftEye") return BoneRole{BoneKind::kEye, Side::kLeft, {}};
  if (name == "rightEye") return BoneRole{BoneKind::kEye, Side::kRight, {}};
  return std::nullopt;
}

}  // namespace facewire::tools::rig
