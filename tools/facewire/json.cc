#include "tools/facewire/json.h"

#include <array>
#include <charconv>
#include <cmath>

namespace facewire::tools::json {

void AppendNumber(std::string& out, double value, int decimals) {
  if (!std::isfinite(value)) {
    out += "null";
    return;
  }
  // Any finite double with a few decimals fits: 309 digits before the point at most.
  std::array<char, 384> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::fixed, decimals);
  std::string_view number(text.data(), static_cast<std::size_t>(end - text.data()));
  if (number.find('.') != std::string_view::npos) {
    number = number.substr(0, number.find_last_not_of('0') + 1);
    if (number.ends_with('.')) number.remove_suffix(1);
  }
  out += number == "-0" ? "0" : number;
}

void AppendInteger(std::string& out, std::int64_t value) { out += std::to_string(value); }

void AppendString(std::string& out, std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20) {
      out += "\\u00";
      out += kHex[byte >> 4U];
      out += kHex[byte & 15U];
    } else {
      out += c;
    }
  }
  out += '"';
}

}  // namespace facewire::tools::json
