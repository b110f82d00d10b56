#include "app/marker_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "app/error.h"

namespace facewire::app {
namespace {

constexpr std::array<std::string_view, 3> kRowColumns = {"frame", "time_s", "t_us"};

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(kBlank) - first + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string_view> Split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(Trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string Where(const std::filesystem::path& path, std::size_t line) {
  return path.string() + ":" + std::to_string(line) + ": ";
}

float ToNumber(std::string_view text, const std::string& where) {
  float value = 0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || parsed != end || !std::isfinite(value))
    throw BadInput(where + "\"" + std::string(text) + "\" is not a finite number");
  return value;
}

// The name without its axis when `column` ends in _x, _y or _z as given.
std::string_view MarkerOf(std::string_view column, char axis) {
  if (column.size() < 3 || column[column.size() - 2] != '_' || column.back() != axis) return {};
  return column.substr(0, column.size() - 2);
}

}  // namespace

NumberTable ReadNumberTable(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path))
    throw BadInput(path.string() + ": there is no such file");
  std::ifstream in(path);
  if (!in) throw BadInput(path.string() + ": cannot be opened");
  NumberTable table;
  std::string line;
  std::size_t number = 1;
  if (!std::getline(in, line) || Trimmed(line).empty())
    throw BadInput(Where(path, 1) + "no columns; expected a line of column names");
  std::string_view header = line;
  if (header.starts_with("\xEF\xBB\xBF")) header.remove_prefix(3);  // a byte order mark
  const std::vector<std::string_view> names = Split(header);
  std::vector<bool> wanted;
  for (const std::string_view name : names) {
    wanted.push_back(std::ranges::find(kRowColumns, name) == kRowColumns.end());
    if (wanted.back()) table.columns.emplace_back(name);
  }
  if (table.columns.empty()) throw BadInput(Where(path, 1) + "no columns besides the row numbers");
  const std::size_t expected = names.size();
  while (std::getline(in, line)) {
    ++number;
    if (Trimmed(line).empty()) continue;
    const std::vector<std::string_view> fields = Split(line);
    if (fields.size() != expected)
      throw BadInput(Where(path, number) + std::to_string(fields.size()) +
                     " columns, but line 1 has " + std::to_string(expected));
    for (std::size_t c = 0; c < fields.size(); ++c)
      if (wanted[c])
        table.values.push_back(
            ToNumber(fields[c], Where(path, number) + "column " + std::to_string(c + 1) + ": "));
    table.lines.push_back(number);
  }
  if (table.lines.empty()) throw BadInput(path.string() + ": no rows below the column names");
  return table;
}

std::vector<ShortName> ToNames(const std::filesystem::path& path,
                               const std::vector<std::string>& columns) {
  std::vector<ShortName> names;
  for (const std::string& column : columns) {
    const auto name = ShortName::From(column);
    if (!name)
      throw BadInput(Where(path, 1) + "\"" + column + "\" cannot be a name; 1 to " +
                     std::to_string(kMaxNameLength) + " printable characters without spaces can");
    if (std::ranges::find(names, *name) != names.end())
      throw BadInput(Where(path, 1) + "the name \"" + column + "\" appears twice");
    names.push_back(*name);
  }
  return names;
}

MarkerTable ReadMarkerTable(const std::filesystem::path& path) {
  NumberTable table = ReadNumberTable(path);
  std::vector<std::string> markers;
  for (std::size_t c = 0; c < table.columns.size(); c += 3) {
    const std::string_view marker = MarkerOf(table.columns[c], 'x');
    const bool complete = !marker.empty() && c + 2 < table.columns.size() &&
                          MarkerOf(table.columns[c + 1], 'y') == marker &&
                          MarkerOf(table.columns[c + 2], 'z') == marker;
    if (!complete)
      throw BadInput(Where(path, 1) + "column \"" + table.columns[c] +
                     "\" does not start a marker; expected NAME_x,NAME_y,NAME_z for each marker");
    markers.emplace_back(marker);
  }
  return {ToNames(path, markers), std::move(table.values), std::move(table.lines)};
}

}  // namespace facewire::app
