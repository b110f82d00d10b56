#include "tools/facewire/rig/shape_names.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/facewire/rig/name_tables.h"

namespace facewire::tools::rig {
namespace {

using Synonyms = std::map<std::string, std::string, std::less<>>;

struct Arkit {
  PartName part;
  std::string joined;
};

// VRM's presets, visemes of other makers by what they look like, and whole expressions.
struct Preset {
  std::string name;  // joined words, without a side
  Side side;
  ShapeMatch match;
};

struct Tables {
  std::vector<std::string> names;  // ARKit's
  std::vector<Arkit> arkit;        // the same, taken apart
  std::string unseen;
  Synonyms synonyms;  // both without a side
  std::vector<Preset> presets;
  Synonyms preset_synonyms;
  std::vector<std::string> fillers;
};

Match MatchNamed(const std::string& name) {
  if (name == "combined") return Match::kCombined;
  if (name == "emotion") return Match::kEmotion;
  throw std::logic_error("tools/names/shapes.json: a preset is combined or emotion, not " + name);
}

std::size_t OrderOf(const std::vector<std::string>& names, const std::string& signal) {
  return static_cast<std::size_t>(std::ranges::find(names, signal) - names.begin());
}

Tables ReadTables() {
  const nlohmann::ordered_json json = ShapeTable();
  Tables tables;
  json.at("arkit").get_to(tables.names);
  for (const std::string& name : tables.names) {
    const PartName part = TakeApart(name);
    tables.arkit.push_back({part, part.Joined()});
  }
  json.at("unseen").get_to(tables.unseen);
  json.at("synonyms").get_to(tables.synonyms);
  json.at("presetSynonyms").get_to(tables.preset_synonyms);
  json.at("fillers").get_to(tables.fillers);
  for (const auto& row : json.at("presets")) {
    Preset preset{row.at("name"), SideNamed(row.value("side", "")), {}};
    preset.match.match = MatchNamed(row.at("match"));
    for (const auto& [signal, gain] : row.at("signals").items())
      preset.match.signals.push_back({signal, gain.get<double>(), Side::kNone});
    preset.match.order = OrderOf(tables.names, preset.match.signals.at(0).signal);
    tables.presets.push_back(std::move(preset));
  }
  return tables;
}

const Tables& Table() {
  static const Tables kTables = ReadTables();
  return kTables;
}

// The shape of this name and side; or both sides of it; or one side of a shape that has none.
std::optional<ShapeMatch> FindArkit(std::string_view joined, Side side, Match match) {
  ShapeMatch found{match, {}, Table().names.size()};
  const auto take = [&](std::size_t i, double gain, Side half) {
    found.order = std::min(found.order, i);
    found.signals.push_back({Table().names[i], gain, half});
  };
  for (std::size_t i = 0; i < Table().arkit.size(); ++i) {
    const auto& [part, name] = Table().arkit[i];
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
  const auto& synonyms = Table().preset_synonyms;
  if (const auto at = synonyms.find(joined); at != synonyms.end()) joined = at->second;
  for (const Preset& preset : Table().presets)
    if (preset.name == joined && preset.side == side) return preset.match;
  return std::nullopt;
}

std::optional<ShapeMatch> Find(const PartName& part) {
  const std::string joined = part.Joined();
  if (auto found = FindArkit(joined, part.side, Match::kSpelling)) return found;
  const auto& synonyms = Table().synonyms;
  if (const auto at = synonyms.find(joined); at != synonyms.end())
    return FindArkit(at->second, part.side, Match::kSynonym);
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

const std::vector<std::string>& ArkitShapes() { return Table().names; }
const std::string& UnseenShape() { return Table().unseen; }

std::optional<ShapeMatch> MatchShape(std::string_view name) {
  const auto& names = Table().names;
  if (const auto at = std::ranges::find(names, name); at != names.end())
    return ShapeMatch{
        Match::kExact, {{*at, 1, Side::kNone}}, static_cast<std::size_t>(at - names.begin())};
  PartName part = TakeApart(name);
  // VRoid's names begin with the model's: M_F00_000_00_Fcl_EYE_Close_L.
  const auto& fillers = Table().fillers;
  while (!part.words.empty()) {
    if (auto found = Find(part)) return found;
    if (std::ranges::find(fillers, part.words.front()) == fillers.end()) break;
    part.words.erase(part.words.begin());
  }
  return std::nullopt;
}

}  // namespace facewire::tools::rig
