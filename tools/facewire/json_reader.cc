#include "tools/facewire/json_reader.h"

#include <charconv>

namespace facewire::tools::json {

void Reader::SkipBlanks() noexcept {
  const std::size_t first = rest_.find_first_not_of(" \t\r\n");
  rest_.remove_prefix(first == std::string_view::npos ? rest_.size() : first);
}

bool Reader::Take(char mark) noexcept {
  SkipBlanks();
  if (!rest_.starts_with(mark)) return false;
  rest_.remove_prefix(1);
  return true;
}

bool Reader::Word(std::string_view word) noexcept {
  SkipBlanks();
  if (!rest_.starts_with(word)) return false;
  rest_.remove_prefix(word.size());
  return true;
}

bool Reader::Null() noexcept { return Word("null"); }

std::optional<double> Reader::Number() noexcept {
  SkipBlanks();
  // from_chars would also take "inf" and "nan", which JSON does not have.
  const std::size_t sign = rest_.starts_with('-') ? 1 : 0;
  if (rest_.size() <= sign || rest_[sign] < '0' || rest_[sign] > '9') return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
  if (error != std::errc{}) return std::nullopt;
  rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
  return value;
}

std::optional<std::string_view> Reader::String() noexcept {
  SkipBlanks();
  if (!rest_.starts_with('"')) return std::nullopt;
  for (std::size_t i = 1; i < rest_.size(); ++i) {
    if (rest_[i] == '\\') {
      ++i;
    } else if (rest_[i] == '"') {
      const std::string_view text = rest_.substr(1, i - 1);
      rest_.remove_prefix(i + 1);
      return text;
    }
  }
  return std::nullopt;
}

bool Reader::Skip() noexcept {
  const std::string_view before = rest_;
  if (Skip(0)) return true;
  rest_ = before;
  return false;
}

// NOLINTNEXTLINE(misc-no-recursion): no deeper than kMaxDepth
bool Reader::Skip(int depth) noexcept {
  if (depth == kMaxDepth) return false;
  if (Take('{')) return SkipList('}', true, depth);
  if (Take('[')) return SkipList(']', false, depth);
  return Number() || String() || Null() || Word("true") || Word("false");
}

// NOLINTNEXTLINE(misc-no-recursion): no deeper than kMaxDepth
bool Reader::SkipList(char end, bool keys, int depth) noexcept {
  if (Take(end)) return true;
  do {
    if (keys && !(String() && Take(':'))) return false;
    if (!Skip(depth + 1)) return false;
  } while (Take(','));
  return Take(end);
}

bool Reader::AtEnd() noexcept {
  SkipBlanks();
  return rest_.empty();
}

}  // namespace facewire::tools::json
