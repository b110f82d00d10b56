#include <algorithm>
#include <cmath>

#include "app/rig_file.h"
#include "tools/facewire/rig/canonical_mesh.h"

namespace facewire::tools::rig {
namespace {

// Those of app/rig_file.cc but the irises, which no bone of the skin follows.
constexpr std::string_view kNames[] = {
    "forehead",
    "glabella",
    "nose_bridge",
    "nose_tip",
    "left_nostril",
    "right_nostril",
    "chin",
    "left_jaw",
    "right_jaw",
    "left_cheek",
    "right_cheek",
    "upper_lip",
    "lower_lip",
    "upper_lip_inside",
    "lower_lip_inside",
    "left_mouth_corner",
    "right_mouth_corner",
    "left_eye_outer",
    "left_eye_inner",
    "right_eye_outer",
    "right_eye_inner",
    "left_upper_lid",
    "left_lower_lid",
    "right_upper_lid",
    "right_lower_lid",
    "left_brow_inner",
    "left_brow_middle",
    "left_brow_outer",
    "right_brow_inner",
    "right_brow_middle",
    "right_brow_outer",
};

float Distance(std::int16_t landmark, Point3 place) {
  const Point3 away = kCanonicalMesh[static_cast<std::size_t>(landmark)] - place;
  return std::sqrt(Dot(away, away));
}

}  // namespace

std::optional<NearLandmark> NearestLandmark(Point3 place, std::span<const std::int16_t> taken) {
  constexpr float kNamed = 1;
  constexpr float kAny = 2;
  const auto is_free = [&](std::int16_t landmark) {
    return std::ranges::find(taken, landmark) == taken.end();
  };
  std::optional<NearLandmark> nearest;
  const auto offer = [&](std::int16_t landmark, std::string_view name, float limit) {
    const float distance = Distance(landmark, place);
    if (distance > limit || !is_free(landmark)) return;
    if (!nearest || distance < nearest->distance_cm) nearest = {landmark, name, distance};
  };
  for (const std::string_view name : kNames)
    if (const auto landmark = app::LandmarkByName(name)) offer(*landmark, name, kNamed);
  if (nearest) return nearest;
  for (std::size_t i = 0; i < kCanonicalMesh.size(); ++i)
    offer(static_cast<std::int16_t>(i), {}, kAny);
  return nearest;
}

std::string_view NearestName(Point3 place) {
  return *std::ranges::min_element(kNames, {}, [&](std::string_view name) {
    return Distance(app::LandmarkByName(name).value_or(0), place);
  });
}

}  // namespace facewire::tools::rig
