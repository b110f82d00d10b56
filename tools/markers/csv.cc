#include <cmath>
#include <cstddef>

#include "app/error.h"
#include "tools/markers/take.h"
#include "tools/markers/text.h"

namespace facewire::tools::markers {
namespace {

[[noreturn]] void Refuse(const std::string& name, std::size_t line, const std::string& what) {
  throw app::BadInput(name + ":" + std::to_string(line) + ": " + what);
}

struct Columns {
  std::vector<std::string> names;
  std::vector<std::size_t> first;  // column of the marker's x
  std::ptrdiff_t time = -1;
};

Columns ReadHeader(const std::vector<std::string_view>& header, const std::string& name) {
  Columns columns;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i] == "time" || header[i] == "time_s") columns.time = static_cast<std::ptrdiff_t>(i);
    if (!header[i].ends_with("_x")) continue;
    const std::string marker(header[i].substr(0, header[i].size() - 2));
    if (i + 2 >= header.size() || header[i + 1] != marker + "_y" ||
        header[i + 2] != marker + "_z") {
      Refuse(name, 1, marker + "_x is not followed by " + marker + "_y and " + marker + "_z");
    }
    columns.names.push_back(marker);
    columns.first.push_back(i);
  }
  if (columns.names.empty()) Refuse(name, 1, "no columns NAME_x,NAME_y,NAME_z");
  return columns;
}

}  // namespace

Take ReadCsv(const std::string& contents, const std::string& name) {
  const std::vector<std::string_view> lines = Lines(contents);
  if (lines.empty()) throw app::BadInput(name + ": it is empty");
  const std::vector<std::string_view> header = Fields(lines[0], ',');
  const Columns columns = ReadHeader(header, name);
  Take take;
  take.names = columns.names;
  std::vector<double> times;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (Trim(lines[i]).empty()) continue;
    const std::vector<std::string_view> fields = Fields(lines[i], ',');
    if (fields.size() != header.size()) {
      Refuse(name, i + 1,
             std::to_string(fields.size()) + " fields; the header has " +
                 std::to_string(header.size()));
    }
    const auto number = [&](std::size_t column) {
      const auto value = NumberOrGap(fields[column]);
      if (!value) Refuse(name, i + 1, "\"" + std::string(fields[column]) + "\" is not a number");
      return *value;
    };
    std::vector<Point3> frame;
    for (const std::size_t first : columns.first) {
      Point3 p{static_cast<float>(number(first)), static_cast<float>(number(first + 1)),
               static_cast<float>(number(first + 2))};
      if (std::isnan(p.x + p.y + p.z)) p = {NAN, NAN, NAN};
      frame.push_back(p);
    }
    take.frames.push_back(std::move(frame));
    if (columns.time >= 0) times.push_back(number(static_cast<std::size_t>(columns.time)));
  }
  if (times.size() > 1 && times.back() > times.front()) {
    take.rate_hz = static_cast<double>(times.size() - 1) / (times.back() - times.front());
  }
  return take;
}

}  // namespace facewire::tools::markers
