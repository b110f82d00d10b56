#ifndef FACEWIRE_CORE_BASE_NAME_H_
#define FACEWIRE_CORE_BASE_NAME_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/capacity.h"

namespace facewire {

// A short name held in place: of a bone, a channel, a signal. Printable ASCII without spaces.
class ShortName {
 public:
  constexpr ShortName() noexcept = default;

  // nullopt when the text is empty, longer than kMaxNameLength, or has a character outside
  // '!'..'~'.
  static constexpr std::optional<ShortName> From(std::string_view text) noexcept {
    if (text.empty() || text.size() > kMaxNameLength) return std::nullopt;
    if (!std::ranges::all_of(text, [](char c) { return c >= '!' && c <= '~'; }))
      return std::nullopt;
    ShortName name;
    std::ranges::copy(text, name.text_.begin());
    name.size_ = static_cast<std::uint8_t>(text.size());
    return name;
  }

  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr std::string_view view() const noexcept { return {text_.data(), size_}; }
  friend constexpr bool operator==(const ShortName& a, const ShortName& b) noexcept {
    return a.view() == b.view();
  }

 private:
  std::array<char, kMaxNameLength> text_{};
  std::uint8_t size_ = 0;
};

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_NAME_H_
