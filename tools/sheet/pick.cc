#include "tools/sheet/pick.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "tools/sheet/character.h"

namespace facewire::tools {
namespace {

// How much of a movement a pose shows; from kShown on it is worth a row.
struct Interest {
  const char* caption;
  double (*amount)(const CharacterPose&);
};
constexpr double kShown = 0.25;
constexpr double kHeadShownDeg = 30;  // that turns the head by kShown of a full amount

constexpr std::array<Interest, 9> kInterests{{
    {"eyes shut", [](const CharacterPose& p) { return std::min(p.lid_left, p.lid_right); }},
    {"mouth open", [](const CharacterPose& p) { return p.jaw; }},
    {"smile",
     [](const CharacterPose& p) { return (p.corner_left_y + p.corner_right_y) / 2 - p.jaw; }},
    {"head turned", [](const CharacterPose& p) { return std::abs(p.yaw_deg) / kHeadShownDeg; }},
    {"brows up", [](const CharacterPose& p) { return (p.brow_left + p.brow_right) / 2; }},
    {"lips pursed",
     [](const CharacterPose& p) { return -(p.corner_left_x + p.corner_right_x) / 2; }},
    {"head tilted", [](const CharacterPose& p) { return std::abs(p.roll_deg) / kHeadShownDeg; }},
    {"brows down", [](const CharacterPose& p) { return -(p.brow_left + p.brow_right) / 2; }},
    {"head nods", [](const CharacterPose& p) { return std::abs(p.pitch_deg) / kHeadShownDeg; }},
}};

double Restlessness(const CharacterPose& p) {
  const auto square = [](double v) { return v * v; };
  return square(p.jaw) + square(p.lid_left) + square(p.lid_right) + square(p.brow_left) +
         square(p.brow_right) + square(p.corner_left_x) + square(p.corner_right_x) +
         square(p.corner_left_y) + square(p.corner_right_y) + square(p.yaw_deg / kHeadShownDeg) +
         square(p.pitch_deg / kHeadShownDeg) + square(p.roll_deg / kHeadShownDeg);
}

}  // namespace

std::vector<Pick> PickMoments(const Rig& rig, std::span<const RigPose> poses, std::size_t count) {
  std::vector<CharacterPose> characters;
  characters.reserve(poses.size());
  for (const RigPose& pose : poses) characters.push_back(CharacterPoseOf(rig, pose));

  std::vector<Pick> picks;
  const auto is_free = [&](std::size_t index) {
    return std::ranges::none_of(picks, [&](const Pick& pick) {
      return std::chrono::abs(poses[pick.index].captured - poses[index].captured) <
             std::chrono::milliseconds(500);
    });
  };
  // The best free pose by an amount, taken when the amount is at least `least`.
  const auto take = [&](const char* caption, double least, const auto& amount) {
    std::size_t best = poses.size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (is_free(i) && (best == poses.size() || amount(characters[i]) > amount(characters[best])))
        best = i;
    }
    if (best < poses.size() && amount(characters[best]) >= least) picks.push_back({best, caption});
  };

  if (count > 0) take("calm", -1e9, [](const CharacterPose& p) { return -Restlessness(p); });
  for (const Interest& interest : kInterests) {
    if (picks.size() < count) take(interest.caption, kShown, interest.amount);
  }
  std::ranges::sort(picks, {}, &Pick::index);
  return picks;
}

}  // namespace facewire::tools
