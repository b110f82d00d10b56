#include "tools/markers/take.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "app/error.h"
#include "tools/markers/table.h"

namespace facewire::tools::markers {
namespace {

std::string Lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

double CentimetresPer(const std::string& unit, const std::string& name) {
  const std::string lower = Lower(unit);
  if (lower == "mm") return 0.1;
  if (lower == "cm") return 1;
  if (lower == "m") return 100;
  if (lower == "in" || lower == "inches") return 2.54;
  throw app::BadInput(name + ": its unit is \"" + unit + "\"; mm, cm, m or in would be right");
}

std::uint64_t Take::Number(std::size_t frame) const {
  return numbers.empty() ? frame : numbers[frame];
}

std::int64_t Take::TimeUs(std::size_t frame) const {
  if (!times_us.empty()) return times_us[frame] - times_us.front();
  constexpr double kUnknownRateHz = 60;
  const double since = static_cast<double>(Number(frame)) - static_cast<double>(Number(0));
  return std::llround(since * 1e6 / (rate_hz > 0 ? rate_hz : kUnknownRateHz));
}

Take ReadTake(const std::string& path) {
  const std::string ending = Lower(std::filesystem::path(path).extension().string());
  if (ending != ".csv" && ending != ".trc" && ending != ".c3d")
    throw app::BadInput(path + ": not a marker file; .csv, .trc or .c3d would be right");
  const std::string contents = ReadFile(path);
  Take take = ending == ".csv"   ? ReadCsv(contents, path)
              : ending == ".trc" ? ReadTrc(contents, path)
                                 : ReadC3d(contents, path);
  if (take.names.empty()) throw app::BadInput(path + ": it names no markers");
  if (take.frames.empty()) throw app::BadInput(path + ": it has no frames");
  for (std::size_t f = 1; f < take.frames.size(); ++f) {
    if (take.Number(f) > take.Number(f - 1) && take.TimeUs(f) >= take.TimeUs(f - 1)) continue;
    throw app::BadInput(path + ": frame " + std::to_string(take.Number(f)) + " comes after frame " +
                        std::to_string(take.Number(f - 1)) +
                        "; a recording is in the order of time");
  }
  return take;
}

}  // namespace facewire::tools::markers
