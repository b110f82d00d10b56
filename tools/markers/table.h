#ifndef FACEWIRE_TOOLS_MARKERS_TABLE_H_
#define FACEWIRE_TOOLS_MARKERS_TABLE_H_

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace facewire::tools::markers {

// Columns of numbers from a comma-separated text under a line of column names.
struct Table {
  std::vector<std::string> columns;
  std::vector<double> values;      // rows x columns, by rows; NaN where a field is empty or "nan"
  std::vector<std::size_t> lines;  // of the file, from 1, for each row

  std::size_t rows() const { return lines.size(); }
  double at(std::size_t row, std::size_t column) const {
    return values[row * columns.size() + column];
  }
};

// Reads the columns whose name is `wanted`; what is in the others does not matter. Empty lines are
// skipped. `name` is the file's, for messages. Throws BadInput with the line: no line of names, a
// row of another length, something that is not a number or too large for a float.
Table ReadTable(std::string_view contents, const std::string& name,
                const std::function<bool(std::string_view)>& wanted);

// "frame", "time", "time_s" and "t_us": they count or time the rows and are no data.
bool IsRowColumn(std::string_view column);

// The whole file. Throws BadInput when it cannot be read.
std::string ReadFile(const std::string& path);

}  // namespace facewire::tools::markers

#endif  // FACEWIRE_TOOLS_MARKERS_TABLE_H_
