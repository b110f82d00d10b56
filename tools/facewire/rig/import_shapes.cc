#include "tools/facewire/rig/import_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/capacity.h"
#include "tools/facewire/rig/rig_names.h"
#include "tools/facewire/rig/shape_names.h"

namespace facewire::tools::rig {
namespace {

// A shape or an expression that could answer to signals.
struct Candidate {
  std::string name;
  bool expression = false;
  ShapeMatch match;
  std::vector<CharacterExpression::Bind> binds;
};

bool IsGaze(const SignalShare& share) { return share.signal.starts_with("eyeLook"); }

std::vector<Candidate> CandidatesOf(const Character& character, ImportPlan& plan) {
  std::vector<Candidate> candidates;
  for (const CharacterExpression& expression : character.expressions) {
    auto match = MatchShape(expression.name);
    if (!match || expression.binds.empty()) continue;
    // The eyes' bones turn, and the expression would turn them again.
    if (character.looks_by_bones && std::ranges::any_of(match->signals, IsGaze)) continue;
    candidates.push_back({expression.name, true, std::move(*match), expression.binds});
  }
  for (std::size_t i = 0; i < character.shapes.size(); ++i) {
    const CharacterShape& shape = character.shapes[i];
    auto match = MatchShape(shape.name);
    if (!match) continue;
    if (!shape.moves) {
      plan.notes.push_back(Shown(shape.name) + " is there, but moves no vertex");
      continue;
    }
    candidates.push_back({shape.name, false, std::move(*match), {{i, 1}}});
  }
  // The surest first; between equals an expression, because its author chose the weights.
  std::ranges::stable_sort(candidates, [](const Candidate& a, const Candidate& b) {
    return std::pair(a.match.match, !a.expression) < std::pair(b.match.match, !b.expression);
  });
  return candidates;
}

// Which signals are spoken for, and by what.
class Claims {
 public:
  // The holder of a signal of the candidate, or null.
  const std::string* HolderOf(const Candidate& candidate) const {
    for (const SignalShare& share : candidate.match.signals)
      for (const auto& [key, holder] : holders_)
        if (key.first == share.signal &&
            (key.second == share.half || key.second == Side::kNone || share.half == Side::kNone))
          return &holder;
    return nullptr;
  }
  void Take(const Candidate& candidate) {
    for (const SignalShare& share : candidate.match.signals)
      holders_.emplace(std::pair(share.signal, share.half), candidate.name);
  }
  bool Has(std::string_view signal) const {
    return std::ranges::any_of(holders_,
                               [&](const auto& claim) { return claim.first.first == signal; });
  }

 private:
  std::map<std::pair<std::string, Side>, std::string> holders_;
};

std::string WhyOf(const Candidate& candidate) {
  return (candidate.expression ? "expression " + Shown(candidate.name) + ", " : std::string()) +
         Describe(candidate.match.match);
}

struct Driven {
  std::map<std::string, double> gains;
  std::vector<std::string> why;
  std::size_t order = ArkitShapes().size();
};

void Drive(const Candidate& candidate, std::map<std::size_t, Driven>& driven) {
  for (const auto& bind : candidate.binds) {
    Driven& shape = driven[bind.shape];
    for (const SignalShare& share : candidate.match.signals)
      shape.gains[share.signal] += share.gain * bind.weight;
    shape.order = std::min(shape.order, candidate.match.order);
    shape.why.push_back(WhyOf(candidate));
  }
}

// The strongest drives that a channel has room for, strongest first; equals by name.
Drives StrongestOf(const std::map<std::string, double>& gains) {
  Drives drives(gains.begin(), gains.end());
  std::erase_if(drives, [](const auto& drive) { return std::abs(drive.second) < 1e-4; });
  std::ranges::stable_sort(
      drives, [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
  drives.resize(std::min(drives.size(), kMaxDrives));
  return drives;
}

std::string Listed(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

}  // namespace

void PlanShapes(const Character& character, std::size_t room, RigNames& names, ImportPlan& plan) {
  Claims claims;
  std::map<std::size_t, Driven> driven;
  std::set<std::string> matched;
  for (const Candidate& candidate : CandidatesOf(character, plan)) {
    if (!candidate.expression) matched.insert(candidate.name);
    if (candidate.match.signals[0].signal == UnseenShape()) {
      plan.notes.push_back(Shown(candidate.name) + " is " + UnseenShape() +
                           ", which no landmark shows: a profile of your own may");
      continue;
    }
    if (const std::string* holder = claims.HolderOf(candidate)) {
      if (*holder != candidate.name)
        plan.notes.push_back((candidate.expression ? "expression " : "") + Shown(candidate.name) +
                             " is not used: " + Shown(*holder) + " shows the same");
      continue;
    }
    claims.Take(candidate);
    Drive(candidate, driven);
  }
  for (const auto& [index, shape] : driven) {
    PlannedParameter parameter;
    parameter.original = character.shapes[index].name;
    parameter.why = Listed(shape.why);
    parameter.drives = StrongestOf(shape.gains);
    parameter.order = shape.order;
    if (!parameter.drives.empty()) plan.parameters.push_back(std::move(parameter));
  }
  std::ranges::stable_sort(plan.parameters, {}, &PlannedParameter::order);
  if (plan.parameters.size() > room) {
    plan.notes.push_back(std::to_string(plan.parameters.size() - room) +
                         " shapes were left out: a rig has " + std::to_string(kMaxChannels) +
                         " channels");
    plan.parameters.resize(room);
  }
  for (PlannedParameter& parameter : plan.parameters)
    parameter.name = names.Take(parameter.original, "shape", kMaxNameLength);
  for (const std::string& arkit : ArkitShapes())
    if (!claims.Has(arkit)) plan.lacking.push_back(arkit);
  for (std::size_t i = 0; i < character.shapes.size(); ++i)
    if (!driven.contains(i) && !matched.contains(character.shapes[i].name) &&
        !MatchShape(character.shapes[i].name))
      plan.unknown_shapes.push_back(character.shapes[i].name);
}

}  // namespace facewire::tools::rig
