#include <cmath>
#include <cstddef>

#include "app/error.h"
#include "tools/markers/take.h"
#include "tools/markers/text.h"

namespace facewire::tools::markers {
namespace {

constexpr std::size_t kFirstMarkerField = 2;  // after the frame number and the time

[[noreturn]] void Refuse(const std::string& name, std::size_t line, const std::string& what) {
  throw app::BadInput(name + ":" + std::to_string(line) + ": " + what);
}

// The value below the name `key` in the file's table of facts (lines 2 and 3).
std::string Fact(const std::vector<std::string_view>& keys,
                 const std::vector<std::string_view>& values, std::string_view key,
                 const std::string& name) {
  for (std::size_t i = 0; i < keys.size() && i < values.size(); ++i) {
    if (keys[i] == key) return std::string(values[i]);
  }
  Refuse(name, 2, "no " + std::string(key) + "; a TRC file has it here");
}

std::vector<Point3> ReadFrame(const std::vector<std::string_view>& fields, std::size_t markers,
                              double cm, const std::string& name, std::size_t line) {
  std::vector<Point3> frame(markers, Point3{NAN, NAN, NAN});
  for (std::size_t m = 0; m < markers; ++m) {
    double xyz[3] = {NAN, NAN, NAN};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Exporters cut empty fields off the end of a line.
      const std::size_t at = kFirstMarkerField + 3 * m + axis;
      if (at >= fields.size()) break;
      const auto value = NumberOrGap(fields[at]);
      if (!value) Refuse(name, line, "\"" + std::string(fields[at]) + "\" is not a number");
      xyz[axis] = *value * cm;
    }
    if (std::isnan(xyz[0] + xyz[1] + xyz[2])) continue;
    frame[m] = {static_cast<float>(xyz[0]), static_cast<float>(xyz[1]), static_cast<float>(xyz[2])};
  }
  return frame;
}

}  // namespace

Take ReadTrc(const std::string& contents, const std::string& name) {
  const std::vector<std::string_view> lines = Lines(contents);
  if (lines.size() < 5 || !lines[0].starts_with("PathFileType")) {
    Refuse(name, 1, "not a TRC file, which begins with PathFileType and has five lines of header");
  }
  const auto keys = Fields(lines[1], '\t');
  const auto values = Fields(lines[2], '\t');
  const double cm = CentimetresPer(Fact(keys, values, "Units", name), name);
  Take take;
  const auto rate = NumberOrGap(Fact(keys, values, "DataRate", name));
  if (!rate || !(*rate > 0)) Refuse(name, 3, "DataRate is not a positive number");
  take.rate_hz = *rate;
  const auto header = Fields(lines[3], '\t');
  for (std::size_t i = kFirstMarkerField; i < header.size(); ++i) {
    if (!header[i].empty()) take.names.emplace_back(header[i]);
  }
  for (std::size_t i = 5; i < lines.size(); ++i) {
    if (Trim(lines[i]).empty()) continue;
    const auto fields = Fields(lines[i], '\t');
    if (fields.size() > kFirstMarkerField + 3 * take.names.size() + 1) {
      Refuse(name, i + 1,
             std::to_string(fields.size()) + " fields for " + std::to_string(take.names.size()) +
                 " markers");
    }
    take.frames.push_back(ReadFrame(fields, take.names.size(), cm, name, i + 1));
  }
  return take;
}

}  // namespace facewire::tools::markers
