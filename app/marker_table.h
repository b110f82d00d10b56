#ifndef FACEWIRE_APP_MARKER_TABLE_H_
#define FACEWIRE_APP_MARKER_TABLE_H_

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/name.h"

namespace facewire::app {

// A comma-separated table of finite numbers under a line of column names. The columns "frame",
// "time_s" and "t_us" count or time the rows and are left out; empty lines are skipped.
struct NumberTable {
  std::vector<std::string> columns;
  std::vector<float> values;       // rows x columns, by rows
  std::vector<std::size_t> lines;  // of the file, from 1, for each row
  std::size_t rows() const { return lines.size(); }
};

// Columns NAME_x, NAME_y, NAME_z in that order for each marker; positions in cm.
struct MarkerTable {
  std::vector<ShortName> markers;
  std::vector<float> positions_cm;  // rows x 3 markers, by rows
  std::vector<std::size_t> lines;
  std::size_t rows() const { return lines.size(); }
};

// BadInput, one line with file, line and column: missing file, no columns, no rows, a row of
// another length, something that is not a finite number, a name twice or one that facewire cannot
// carry.
NumberTable ReadNumberTable(const std::filesystem::path& path);
MarkerTable ReadMarkerTable(const std::filesystem::path& path);

// Column names as the names of signals. BadInput: empty, too long, spaces, twice.
std::vector<ShortName> ToNames(const std::filesystem::path& path,
                               const std::vector<std::string>& columns);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_MARKER_TABLE_H_
