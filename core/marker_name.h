#ifndef FACEWIRE_CORE_MARKER_NAME_H_
#define FACEWIRE_CORE_MARKER_NAME_H_

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/capacity.h"

namespace facewire {

// The landmark of "lm0".."lm477", the names that landmarks have where markers are named; nullopt
// for any other.
inline std::optional<std::int16_t> LandmarkOf(std::string_view marker) noexcept {
  if (!marker.starts_with("lm")) return std::nullopt;
  std::int16_t index = -1;
  const char* end = marker.data() + marker.size();
  const auto [parsed, error] = std::from_chars(marker.data() + 2, end, index);
  if (error != std::errc{} || parsed != end || index < 0 ||
      index >= static_cast<std::int16_t>(kMaxLandmarks))
    return std::nullopt;
  return index;
}

}  // namespace facewire

#endif  // FACEWIRE_CORE_MARKER_NAME_H_
