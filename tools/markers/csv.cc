#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "app/error.h"
#include "tools/markers/table.h"
#include "tools/markers/take.h"

namespace facewire::tools::markers {
namespace {

[[noreturn]] void Refuse(const std::string& name, std::size_t line, const std::string& what) {
  throw app::BadInput(name + ":" + std::to_string(line) + ": " + what);
}

bool IsCoordinate(std::string_view column) {
  return column.ends_with("_x") || column.ends_with("_y") || column.ends_with("_z");
}

struct Columns {
  std::vector<std::string> names;
  std::vector<std::size_t> first;  // column of the marker's x
  std::optional<std::size_t> frame, time_s, t_us;
};

Columns ReadHeader(const Table& table, const std::string& name) {
  Columns columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& column = table.columns[i];
    if (column == "frame") columns.frame = i;
    if (column == "time" || column == "time_s") columns.time_s = i;
    if (column == "t_us") columns.t_us = i;
    if (IsRowColumn(column)) continue;
    const std::string marker =
        column.substr(0, column.size() - std::min<std::size_t>(2, column.size()));
    if (!column.ends_with("_x"))
      Refuse(name, 1,
             "column " + column + " does not start a marker; NAME_x,NAME_y,NAME_z would be right");
    if (i + 2 >= table.columns.size() || table.columns[i + 1] != marker + "_y" ||
        table.columns[i + 2] != marker + "_z")
      Refuse(name, 1, column + " is not followed by " + marker + "_y and " + marker + "_z");
    if (std::ranges::find(columns.names, marker) != columns.names.end())
      Refuse(name, 1, "the marker " + marker + " appears twice");
    columns.names.push_back(marker);
    columns.first.push_back(i);
    i += 2;
  }
  if (columns.names.empty()) Refuse(name, 1, "no columns NAME_x,NAME_y,NAME_z");
  return columns;
}

std::vector<Point3> ReadRow(const Table& table, std::size_t row, const Columns& columns) {
  std::vector<Point3> points;
  for (const std::size_t first : columns.first) {
    const Point3 p{static_cast<float>(table.at(row, first)),
                   static_cast<float>(table.at(row, first + 1)),
                   static_cast<float>(table.at(row, first + 2))};
    points.push_back(std::isnan(p.x + p.y + p.z) ? Point3{NAN, NAN, NAN} : p);
  }
  return points;
}

// The numbers of a column that counts or times the rows.
std::vector<double> RowNumbers(const Table& table, std::size_t column, const std::string& name) {
  std::vector<double> numbers;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    numbers.push_back(table.at(row, column));
    if (std::isnan(numbers.back()))
      Refuse(name, table.lines[row], "column " + table.columns[column] + " is empty");
  }
  return numbers;
}

void ReadTimes(const Table& table, const Columns& columns, const std::string& name, Take& take) {
  if (columns.frame) {
    for (const double number : RowNumbers(table, *columns.frame, name)) {
      if (number < 0 || number > 1e15 || std::floor(number) != number)
        Refuse(name, table.lines[take.numbers.size()], "frame is not a whole number from 0 up");
      take.numbers.push_back(static_cast<std::uint64_t>(number));
    }
  }
  if (!columns.t_us && !columns.time_s) return;
  const double to_us = columns.t_us ? 1 : 1e6;
  for (const double time :
       RowNumbers(table, columns.t_us ? *columns.t_us : *columns.time_s, name)) {
    if (std::abs(time * to_us) > 1e15)
      Refuse(name, table.lines[take.times_us.size()], "a time beyond thirty years");
    take.times_us.push_back(std::llround(time * to_us));
  }
  const auto span_us = take.times_us.empty() ? 0 : take.times_us.back() - take.times_us.front();
  if (span_us > 0)
    take.rate_hz =
        static_cast<double>(take.times_us.size() - 1) * 1e6 / static_cast<double>(span_us);
}

}  // namespace

Take ReadCsv(const std::string& contents, const std::string& name, CsvRules rules) {
  const Table table = ReadTable(contents, name, [&](std::string_view column) {
    return rules.only_markers || IsRowColumn(column) || IsCoordinate(column);
  });
  const Columns columns = ReadHeader(table, name);
  Take take;
  take.names = columns.names;
  ReadTimes(table, columns, name, take);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    take.frames.push_back(ReadRow(table, row, columns));
    const auto gap =
        std::ranges::find_if(take.frames.back(), [](Point3 p) { return std::isnan(p.x); });
    if (rules.gaps || gap == take.frames.back().end()) continue;
    Refuse(name, table.lines[row],
           "the marker " + take.names[static_cast<std::size_t>(gap - take.frames.back().begin())] +
               " was not seen here; a sample needs them all");
  }
  return take;
}

}  // namespace facewire::tools::markers
