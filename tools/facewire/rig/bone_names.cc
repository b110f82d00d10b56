#include "tools/facewire/rig/bone_names.h"

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/facewire/rig/name_tables.h"

namespace facewire::tools::rig {
namespace {

using Json = nlohmann::ordered_json;
using Strings = std::vector<std::string>;

struct Name {
  PartName part;
  std::string joined;
};

// What is looked for in a name; one that is there is enough.
struct Pattern {
  Strings words;  // of the name
  Strings parts;  // somewhere in the joined name
  Strings names;  // the joined name
  Strings last;   // the last word

  bool Fits(const Name& name) const {
    const auto is = [](const std::string& text) {
      return [&text](const std::string& other) { return text == other; };
    };
    const auto& own = name.part.words;
    return std::ranges::any_of(words, [&](const std::string& w) { return name.part.Has(w); }) ||
           std::ranges::any_of(
               parts, [&](const std::string& p) { return name.joined.find(p) != p.npos; }) ||
           std::ranges::any_of(names, is(name.joined)) ||
           (!own.empty() && std::ranges::any_of(last, is(own.back())));
  }
};

struct Rule {
  Pattern pattern;
  std::optional<Pattern> also;
  std::optional<bool> sided;
  Strings heights;  // empty: any
  std::size_t most_words = std::numeric_limits<std::size_t>::max();
  std::optional<BoneRole> role;  // of a bone of no side
};

struct Tables {
  Pattern helpers;
  std::vector<std::pair<std::string, Pattern>> heights;
  std::vector<Rule> rules;
  std::map<std::string, BoneRole, std::less<>> humanoid;
};

BoneRole RoleOf(const Json& row) {
  static const std::map<std::string, BoneKind> kKinds = {{"head", BoneKind::kHead},
                                                         {"neck", BoneKind::kNeck},
                                                         {"jaw", BoneKind::kJaw},
                                                         {"eye", BoneKind::kEye},
                                                         {"upper_lid", BoneKind::kUpperLid},
                                                         {"lower_lid", BoneKind::kLowerLid},
                                                         {"skin", BoneKind::kSkin}};
  return {kKinds.at(row.at("kind")), SideNamed(row.value("side", "")), row.value("landmark", "")};
}

Pattern PatternOf(const Json& row) {
  return {row.value("words", Strings()), row.value("parts", Strings()),
          row.value("names", Strings()), row.value("last", Strings())};
}

Tables ReadTables() {
  const Json json = BoneTable();
  Tables tables;
  tables.helpers = PatternOf(json.at("helpers"));
  for (const auto& [height, row] : json.at("heights").items())
    tables.heights.emplace_back(height, PatternOf(row));
  for (const Json& row : json.at("rules")) {
    Rule rule;
    rule.pattern = PatternOf(row);
    if (row.contains("and")) rule.also = PatternOf(row.at("and"));
    if (row.contains("sided")) rule.sided = row.at("sided").get<bool>();
    rule.heights = row.value("heights", Strings());
    rule.most_words = row.value("most_words", rule.most_words);
    if (row.contains("kind")) rule.role = RoleOf(row);
    tables.rules.push_back(std::move(rule));
  }
  for (const auto& [bone, row] : json.at("humanoid").items()) tables.humanoid[bone] = RoleOf(row);
  return tables;
}

const Tables& Table() {
  static const Tables kTables = ReadTables();
  return kTables;
}

std::string HeightOf(const Name& name) {
  for (const auto& [height, pattern] : Table().heights)
    if (pattern.Fits(name)) return height;
  return "unknown";
}

bool Fits(const Rule& rule, const Name& name, const std::string& height) {
  return rule.pattern.Fits(name) && (!rule.also || rule.also->Fits(name)) &&
         (!rule.sided || *rule.sided == (name.part.side != Side::kNone)) &&
         (rule.heights.empty() || std::ranges::find(rule.heights, height) != rule.heights.end()) &&
         name.part.words.size() <= rule.most_words;
}

Name Read(std::string_view name) {
  PartName part = TakeApart(name);
  std::string joined = part.Joined();
  return {std::move(part), std::move(joined)};
}

}  // namespace

std::optional<BoneRole> MatchBone(std::string_view text) {
  const Name name = Read(text);
  if (Table().helpers.Fits(name)) return std::nullopt;
  const std::string height = HeightOf(name);
  for (const Rule& rule : Table().rules) {
    if (!Fits(rule, name, height)) continue;
    std::optional<BoneRole> role = rule.role;
    if (!role || name.part.side == Side::kNone) return role;
    role->side = name.part.side;
    if (!role->landmark.empty())
      role->landmark = (role->side == Side::kLeft ? "left_" : "right_") + role->landmark;
    return role;
  }
  return std::nullopt;
}

bool IsHelper(std::string_view name) { return Table().helpers.Fits(Read(name)); }

std::optional<BoneRole> MatchHumanoid(std::string_view name) {
  const auto at = Table().humanoid.find(name);
  return at == Table().humanoid.end() ? std::nullopt : std::optional(at->second);
}

}  // namespace facewire::tools::rig
