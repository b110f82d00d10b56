#include "tools/facewire/marker_layout.h"

#include <algorithm>
#include <string_view>

namespace facewire::tools {
namespace {

// The place of a marker, which is added to the layout if it is not there. A profile and all bones
// together read far fewer markers than a face has points.
std::int16_t PlaceOf(std::string_view name, MarkerLayout& layout) {
  const auto found = std::ranges::find(layout.names, name);
  if (found != layout.names.end()) return layout.points[found - layout.names.begin()];
  std::int16_t free = 0;
  while (std::ranges::find(layout.points, free) != layout.points.end()) ++free;
  layout.names.emplace_back(name);
  layout.points.push_back(free);
  return free;
}

}  // namespace

MarkerLayout LayOutMarkers(const retarget::ExpressionMapping* profile, Rig& rig) {
  MarkerLayout layout;
  if (profile != nullptr) {
    for (const ShortName& name : profile->markers()) layout.names.emplace_back(name.view());
    layout.points.assign(profile->point_indices().begin(), profile->point_indices().end());
  }
  // Landmarks first: their places are given.
  for (Bone& bone : rig.bones) {
    if (bone.landmark < 0) continue;
    const bool known = std::ranges::find(layout.points, bone.landmark) != layout.points.end();
    if (profile == nullptr) {
      if (known) continue;
      layout.names.push_back("lm" + std::to_string(bone.landmark));
      layout.points.push_back(bone.landmark);
    } else if (!profile->reads_landmarks() || !known) {
      bone.landmark = -1;
    }
  }
  const std::size_t others = layout.names.size();
  for (Bone& bone : rig.bones) {
    if (!bone.marker.empty()) bone.landmark = PlaceOf(bone.marker.view(), layout);
  }
  const bool rig_reads = profile == nullptr || layout.names.size() > others;
  layout.needed_by = profile == nullptr ? "the rig"
                     : rig_reads        ? "the profile or the rig"
                                        : "the profile";
  return layout;
}

}  // namespace facewire::tools
