#include "tools/facewire/rig/rig_names.h"

#include <algorithm>

namespace facewire::tools::rig {

std::string RigNames::Take(std::string_view name, std::string_view otherwise, std::size_t longest) {
  std::string text;
  for (const char c : name) {
    // Quotes and backslashes are allowed, but nobody wants to type them.
    if (c > ' ' && c <= '~' && c != '"' && c != '\\') {
      text += c;
    } else if (c == ' ' && !text.empty() && text.back() != '_') {
      text += '_';
    }
  }
  if (text.empty()) text = otherwise;
  text.resize(std::min(text.size(), longest));
  std::string unique = text;
  for (int number = 2; !taken_.insert(unique).second; ++number) {
    const std::string tail = "_" + std::to_string(number);
    unique = text.substr(0, longest - tail.size()) + tail;
  }
  return unique;
}

std::string Shown(std::string_view name) {
  constexpr std::size_t kLongest = 60;
  std::string text(name.substr(0, kLongest));
  // Not in the middle of a character of UTF-8.
  if (name.size() > kLongest) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U)
      text.pop_back();
    if (!text.empty() && static_cast<unsigned char>(text.back()) >= 0xC0U) text.pop_back();
    text += "...";
  }
  for (char& c : text)
    if ((c >= 0 && c < ' ') || c == 0x7F) c = '?';
  return text.empty() ? "(no name)" : text;
}

}  // namespace facewire::tools::rig
