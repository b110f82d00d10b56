#include "tools/markers/take.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/error.h"

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

Take ReadTake(const std::string& path) {
  const std::string ending = Lower(std::filesystem::path(path).extension().string());
  const auto reader = ending == ".csv"   ? ReadCsv
                      : ending == ".trc" ? ReadTrc
                      : ending == ".c3d" ? ReadC3d
                                         : nullptr;
  if (reader == nullptr)
    throw app::BadInput(path + ": not a marker file; .csv, .trc or .c3d would be right");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw app::BadInput(path + ": cannot be read; is the path right?");
  const std::string contents((std::istreambuf_iterator<char>(file)),
                             std::istreambuf_iterator<char>());
  Take take = reader(contents, path);
  if (take.names.empty()) throw app::BadInput(path + ": it names no markers");
  if (take.frames.empty()) throw app::BadInput(path + ": it has no frames");
  return take;
}

}  // namespace facewire::tools::markers
