#include "tools/facewire/rig/part_name.h"

#include <algorithm>

namespace facewire::tools::rig {
namespace {

// ASCII alone, whatever the locale.
bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsLower(char c) { return c >= 'a' && c <= 'z'; }
char Lower(char c) { return IsUpper(c) ? static_cast<char>(c - 'A' + 'a') : c; }

std::vector<std::string> WordsOf(std::string_view name) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (std::string_view("_- .").find(c) != std::string_view::npos) {
      words.emplace_back();
      continue;
    }
    // "eyeBlink" and "FCLEye" both have a second word.
    const bool starts = IsUpper(c) && i > 0 &&
                        (IsLower(name[i - 1]) ||
                         (IsUpper(name[i - 1]) && i + 1 < name.size() && IsLower(name[i + 1])));
    if (starts) words.emplace_back();
    words.back() += Lower(c);
  }
  std::erase(words, "");
  return words;
}

std::string_view WithoutNamespace(std::string_view name) {
  if (const std::size_t mark = name.find_last_of(":|"); mark != std::string_view::npos)
    name.remove_prefix(mark + 1);
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return name;
  const std::vector<std::string> behind = WordsOf(name.substr(dot + 1));
  const bool number =
      std::ranges::all_of(name.substr(dot + 1), [](char c) { return c >= '0' && c <= '9'; });
  // "eye.L" and Blender's "eye.001" keep what is before the dot, "Face.eye_L" what is behind it.
  if (number || (behind.size() == 1 && SideNamed(behind[0]) != Side::kNone)) return name;
  return name.substr(dot + 1);
}

}  // namespace

Side SideNamed(std::string_view word) {
  if (word == "l" || word == "left") return Side::kLeft;
  if (word == "r" || word == "right") return Side::kRight;
  return Side::kNone;
}

std::string PartName::Joined() const {
  std::string joined;
  for (const std::string& word : words) joined += word;
  return joined;
}

bool PartName::Has(std::string_view word) const {
  return std::ranges::find(words, word) != words.end();
}

PartName TakeApart(std::string_view name) {
  PartName part;
  part.words = WordsOf(WithoutNamespace(name));
  // The last one counts: "eyeLookInLeft". A name that is nothing but a side stays a name.
  for (std::size_t i = part.words.size(); i-- > 0 && part.words.size() > 1;) {
    const Side side = SideNamed(part.words[i]);
    if (side == Side::kNone) continue;
    part.side = side;
    part.words.erase(part.words.begin() + static_cast<std::ptrdiff_t>(i));
    return part;
  }
  if (part.words.empty()) return part;
  std::string& last = part.words.back();
  for (const std::string_view word : {"left", "right"}) {
    if (last.size() <= word.size() || !last.ends_with(word)) continue;
    part.side = SideNamed(word);
    last.resize(last.size() - word.size());
    break;
  }
  return part;
}

}  // namespace facewire::tools::rig
