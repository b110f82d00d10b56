#include "tools/markers/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "app/error.h"
#include "tools/markers/text.h"

namespace facewire::tools::markers {
namespace {

[[noreturn]] void Refuse(const std::string& name, std::size_t line, const std::string& what) {
  throw app::BadInput(name + ":" + std::to_string(line) + ": " + what);
}

}  // namespace

bool IsRowColumn(std::string_view column) {
  constexpr std::array<std::string_view, 4> kRowColumns = {"frame", "time", "time_s", "t_us"};
  return std::ranges::find(kRowColumns, column) != kRowColumns.end();
}

Table ReadTable(std::string_view contents, const std::string& name,
                const std::function<bool(std::string_view)>& wanted) {
  const std::vector<std::string_view> lines = Lines(contents);
  if (lines.empty() || Trim(lines[0]).empty())
    Refuse(name, 1, "no columns; a line of column names would be right");
  const std::vector<std::string_view> header = Fields(lines[0], ',');
  Table table;
  std::vector<std::size_t> read;
  for (std::size_t c = 0; c < header.size(); ++c) {
    if (!wanted(header[c])) continue;
    table.columns.emplace_back(header[c]);
    read.push_back(c);
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (Trim(lines[i]).empty()) continue;
    const std::vector<std::string_view> fields = Fields(lines[i], ',');
    if (fields.size() != header.size())
      Refuse(name, i + 1,
             std::to_string(fields.size()) + " fields; the header has " +
                 std::to_string(header.size()));
    for (const std::size_t c : read) {
      const auto value = NumberOrGap(fields[c]);
      if (!value || std::abs(*value) > static_cast<double>(std::numeric_limits<float>::max()))
        Refuse(name, i + 1,
               "column " + std::string(header[c]) + ": \"" + std::string(fields[c]) +
                   "\" is not a number" + (value ? " that is small enough" : ""));
      table.values.push_back(*value);
    }
    table.lines.push_back(i + 1);
  }
  return table;
}

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw app::BadInput(path + ": cannot be read; is the path right?");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace facewire::tools::markers
