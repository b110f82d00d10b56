#include "tools/facewire/novelty_report.h"

#include <cinttypes>
#include <cstdio>

#include "core/retarget/trained_space.h"

namespace facewire::tools {
namespace {

// "1:04.2"
std::string Clock(std::int64_t t_us) {
  const std::int64_t tenths = t_us / 100'000;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%" PRId64 ":%02" PRId64 ".%" PRId64, tenths / 600,
                tenths / 10 % 60, tenths % 10);
  return text.data();
}

}  // namespace

void NoveltyReport::Add(std::uint64_t frame, std::int64_t t_us, std::span<const float> novelty) {
  for (std::size_t r = 0; r < novelty.size(); ++r) {
    if (!(novelty[r] > retarget::TrainedSpace::kUnfamiliar)) continue;
    Region& region = regions_[r];
    ++region.unfamiliar;
    if (novelty[r] <= region.worst) continue;
    region.worst = novelty[r];
    region.worst_frame = frame;
    region.worst_t_us = t_us;
  }
}

std::vector<std::string> NoveltyReport::Lines(std::span<const std::string_view> regions) const {
  std::vector<std::string> lines;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Region& region = regions_[r];
    if (region.unfamiliar == 0) continue;
    lines.push_back(std::string(regions[r]) + ": " + std::to_string(region.unfamiliar) +
                    (region.unfamiliar == 1 ? " frame" : " frames") +
                    " unlike any trained pose, most so frame " +
                    std::to_string(region.worst_frame) + " (" + Clock(region.worst_t_us) +
                    "); record a pose like it and train again with it");
  }
  return lines;
}

}  // namespace facewire::tools
