#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/facewire/rig/bone_names.h"
#include "tools/facewire/rig/shape_names.h"

namespace facewire::tools::rig {
namespace {

using nlohmann::json;

const json& Cases(const char* list) {
  static const json kCases = json::parse(std::ifstream(FACEWIRE_NAME_CASES));
  return kCases.at(list);
}

void AddSide(json& found, const char* key, Side side) {
  if (side != Side::kNone) found[key] = side == Side::kLeft ? "left" : "right";
}

// As the cases have it.
json AsJson(const std::optional<ShapeMatch>& found) {
  constexpr std::array kMatches{"exact", "spelling", "synonym", "combined", "emotion"};
  if (!found) return nullptr;
  json shown{{"match", kMatches.at(static_cast<std::size_t>(found->match))}};
  for (const SignalShare& share : found->signals) shown["signals"][share.signal] = share.gain;
  AddSide(shown, "half", found->signals[0].half);
  return shown;
}

json AsJson(const std::optional<BoneRole>& found) {
  constexpr std::array kKinds{"head", "neck", "jaw", "eye", "upper_lid", "lower_lid", "skin"};
  if (!found) return nullptr;
  json shown{{"kind", kKinds.at(static_cast<std::size_t>(found->kind))}};
  AddSide(shown, "side", found->side);
  if (!found->landmark.empty()) shown["landmark"] = found->landmark;
  return shown;
}

void ExpectAll(const char* list, const auto& match) {
  EXPECT_GT(Cases(list).size(), 5U);
  for (const json& row : Cases(list)) {
    const auto name = row.at("name").get<std::string>();
    EXPECT_EQ(AsJson(match(name)), row.at("is")) << name;
  }
}

// The page passes the same cases in tests/tools/host/names.test.mjs.
TEST(NameCases, ShapesMeanWhatTheCasesSay) { ExpectAll("shapes", MatchShape); }
TEST(NameCases, BonesMeanWhatTheCasesSay) { ExpectAll("bones", MatchBone); }
TEST(NameCases, HumanoidBonesMeanWhatTheCasesSay) { ExpectAll("humanoid", MatchHumanoid); }

TEST(NameCases, ArkitsShapesAreItsOwn) {
  for (const std::string& shape : ArkitShapes())
    EXPECT_EQ(AsJson(MatchShape(shape)).at("match"), "exact") << shape;
}

}  // namespace
}  // namespace facewire::tools::rig
