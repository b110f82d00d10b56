#include "tools/facewire/training_files.h"

#include <algorithm>
#include <cmath>

#include "app/error.h"
#include "tools/markers/table.h"
#include "tools/markers/take.h"

namespace facewire::tools {
namespace {

std::vector<ShortName> ToNames(const std::string& path, const std::vector<std::string>& columns) {
  std::vector<ShortName> names;
  for (const std::string& column : columns) {
    const auto name = ShortName::From(column);
    if (!name)
      throw app::BadInput(path + ":1: \"" + column + "\" cannot be a name; 1 to " +
                          std::to_string(kMaxNameLength) +
                          " printable characters without spaces can");
    if (std::ranges::find(names, *name) != names.end())
      throw app::BadInput(path + ":1: the name \"" + column + "\" appears twice");
    names.push_back(*name);
  }
  return names;
}

// Calls `each` with every marker index of a region.
template <class Region, class Each>
void ForEachMarker(Region& region, Each each) {
  for (auto& marker : region.points) each(marker);
  for (auto& marker : region.origin) each(marker);
  for (auto& gap : region.gaps) {
    each(gap.upper);
    each(gap.lower);
  }
}

}  // namespace

TrainingTable ReadSamples(const std::string& path) {
  const markers::Take take =
      markers::ReadCsv(markers::ReadFile(path), path, {.only_markers = true, .gaps = false});
  if (take.frames.empty()) throw app::BadInput(path + ": no rows below the column names");
  TrainingTable samples{ToNames(path, take.names), {}, take.frames.size()};
  for (const auto& frame : take.frames)
    for (const Point3 p : frame) samples.values.insert(samples.values.end(), {p.x, p.y, p.z});
  return samples;
}

TrainingTable ReadTargets(const std::string& path) {
  const markers::Table table =
      markers::ReadTable(markers::ReadFile(path), path,
                         [](std::string_view column) { return !markers::IsRowColumn(column); });
  if (table.columns.empty()) throw app::BadInput(path + ":1: no columns besides the row numbers");
  if (table.rows() == 0) throw app::BadInput(path + ": no rows below the column names");
  TrainingTable targets{ToNames(path, table.columns), {}, table.rows()};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      const double value = table.at(row, column);
      if (std::isnan(value))
        throw app::BadInput(path + ":" + std::to_string(table.lines[row]) + ": column " +
                            table.columns[column] + " is empty; every sample needs its value");
      targets.values.push_back(static_cast<float>(value));
    }
  }
  return targets;
}

void DropUnusedMarkers(app::TrainingSet& training) {
  constexpr std::uint16_t kUnused = 0xFFFF;
  const std::size_t before = training.markers.size();
  std::vector<std::uint16_t> place(before, kUnused);
  for (auto& region : training.regions)
    ForEachMarker(region, [&](std::uint16_t marker) { place[marker] = 0; });
  std::vector<ShortName> markers;
  for (std::size_t m = 0; m < before; ++m) {
    if (place[m] == kUnused) continue;
    place[m] = static_cast<std::uint16_t>(markers.size());
    markers.push_back(training.markers[m]);
  }
  if (markers.size() == before) return;
  std::vector<float> samples;
  for (std::size_t at = 0; at < training.samples.size(); at += 3 * before) {
    for (std::size_t m = 0; m < before; ++m) {
      if (place[m] == kUnused) continue;
      const auto point = training.samples.begin() + static_cast<std::ptrdiff_t>(at + 3 * m);
      samples.insert(samples.end(), point, point + 3);
    }
  }
  for (auto& region : training.regions)
    ForEachMarker(region, [&](std::uint16_t& marker) { marker = place[marker]; });
  training.markers = std::move(markers);
  training.samples = std::move(samples);
}

}  // namespace facewire::tools
