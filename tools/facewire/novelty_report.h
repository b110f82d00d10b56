#ifndef FACEWIRE_TOOLS_FACEWIRE_NOVELTY_REPORT_H_
#define FACEWIRE_TOOLS_FACEWIRE_NOVELTY_REPORT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/capacity.h"

namespace facewire::tools {

// Which poses a profile's training lacks for a performance, region by region.
class NoveltyReport {
 public:
  // One frame; `novelty` as ExpressionMapping::Evaluate gives it.
  void Add(std::uint64_t frame, std::int64_t t_us, std::span<const float> novelty);

  // One line for each region with unfamiliar frames: how many, the one most so and its time, and
  // what to do. `regions`: names, in the order of `novelty`.
  std::vector<std::string> Lines(std::span<const std::string_view> regions) const;

 private:
  struct Region {
    std::size_t unfamiliar = 0;
    float worst = 0;
    std::uint64_t worst_frame = 0;
    std::int64_t worst_t_us = 0;
  };
  std::array<Region, kMaxRegions> regions_{};
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_NOVELTY_REPORT_H_
