#include "tools/facewire/region_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/error.h"

namespace facewire::tools {
namespace {

using retarget::RegionConfig;

constexpr std::array<std::pair<std::string_view, rbf::Kernel>, 6> kKernels = {{
    {"multiquadric", rbf::Kernel::kMultiquadric},
    {"inverse-multiquadric", rbf::Kernel::kInverseMultiquadric},
    {"gaussian", rbf::Kernel::kGaussian},
    {"linear", rbf::Kernel::kLinear},
    {"cubic", rbf::Kernel::kCubic},
    {"thin-plate", rbf::Kernel::kThinPlate},
}};
constexpr std::array<std::pair<std::string_view, rbf::Tail>, 3> kTails = {{
    {"none", rbf::Tail::kNone},
    {"constant", rbf::Tail::kConstant},
    {"linear", rbf::Tail::kLinear},
}};
constexpr std::array<std::pair<std::string_view, retarget::Method>, 2> kMethods = {{
    {"rbf", retarget::Method::kRbf},
    {"nnls", retarget::Method::kNnls},
}};
constexpr std::array<std::string_view, 15> kKeys = {
    "name",   "targets", "points",  "origin",    "gaps",           "gap_gain",  "axes",   "method",
    "kernel", "tail",    "epsilon", "smoothing", "tail_smoothing", "dead_zone", "ignores"};

template <class Table>
auto Parse(const Table& table, std::string_view name, const std::string& where) {
  std::string names;
  for (const auto& [known, value] : table) {
    if (known == name) return value;
    names += (names.empty() ? "" : ", ") + std::string(known);
  }
  throw app::BadInput(where + "\"" + std::string(name) + "\" is not one of " + names);
}

// One [[region]] of the file.
class RegionReader {
 public:
  RegionReader(const std::filesystem::path& path, const toml::table& table,
               const app::TrainingSet& training)
      : path_(path), table_(table), training_(training) {}

  RegionConfig Read(const RegionConfig& defaults) const {
    for (const auto& [key, node] : table_)
      if (std::ranges::find(kKeys, key.str()) == kKeys.end())
        Fail(node, "unknown key \"" + std::string(key.str()) + "\"");
    RegionConfig region = defaults;
    region.name = Name();
    if (const auto* node = table_.get("method"))
      region.method = ParseMethod(Text(*node), Where(*node));
    if (const auto* node = table_.get("kernel"))
      region.rbf.kernel = ParseKernel(Text(*node), Where(*node));
    if (const auto* node = table_.get("tail"))
      region.rbf.tail = ParseTail(Text(*node), Where(*node));
    if (const auto* node = table_.get("epsilon"))
      region.rbf.epsilon = node->is_string() ? ParseEpsilon(Text(*node), Where(*node))
                                             : Number("epsilon", region.rbf.epsilon);
    region.rbf.smoothing = Setting("smoothing", kAutomatic, region.rbf.smoothing);
    region.nnls.ridge = Setting("smoothing", kAutomatic, region.nnls.ridge);
    region.rbf.tail_smoothing = Setting("tail_smoothing", kAutomatic, region.rbf.tail_smoothing);
    region.gap_gain = Number("gap_gain", 1);
    region.dead_zone = Number("dead_zone", 0);
    if (region.dead_zone > 0.25F)
      Fail(*table_.get("dead_zone"), "dead_zone has to be a part of the range, 0 to 0.25");
    Indices("ignores", training_.signals, "target", region.ignores);
    Indices("points", training_.markers, "marker", region.points);
    Indices("origin", training_.markers, "marker", region.origin);
    Indices("targets", training_.signals, "target", region.outputs);
    ReadGaps(region);
    if (region.inputs() == 0) Fail(table_, "a region needs points or gaps");
    if (region.outputs.empty()) Fail(table_, "a region needs targets");
    region.axes = Axes(region);
    if (!region.ignores.empty() && region.axes == 0)
      Fail(*table_.get("ignores"), "ignores needs axes: what is ignored is left out of them");
    return region;
  }

 private:
  std::string Where(const toml::node& node) const {
    return path_.string() + ":" + std::to_string(node.source().begin.line) + ": ";
  }
  [[noreturn]] void Fail(const toml::node& node, const std::string& what) const {
    throw app::BadInput(Where(node) + what);
  }

  std::string Text(const toml::node& node) const {
    const auto text = node.value_exact<std::string>();
    if (!text) Fail(node, "expected a text in quotes");
    return text.value_or("");
  }

  ShortName Name() const {
    const toml::node* node = table_.get("name");
    if (node == nullptr) Fail(table_, "a region needs a name");
    const auto name = ShortName::From(Text(*node));
    if (!name) Fail(*node, "a name has 1 to 31 printable characters and no spaces");
    return name.value_or(ShortName{});
  }

  float Number(const char* key, float otherwise) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return otherwise;
    const auto value = node->value<double>();
    if (!value || !std::isfinite(*value) || *value < 0)
      Fail(*node, std::string(key) + " has to be a number from 0 up");
    return static_cast<float>(value.value_or(0));
  }

  // As Number, or "auto".
  float Setting(const char* key, float automatic, float otherwise) const {
    const toml::node* node = table_.get(key);
    if (node != nullptr && node->is_string() && Text(*node) == "auto") return automatic;
    return Number(key, otherwise);
  }

  std::uint16_t Axes(const RegionConfig& region) const {
    const auto most = static_cast<float>(region.inputs());
    const float axes = Number("axes", std::min(static_cast<float>(region.axes), most));
    if (axes != std::floor(axes) || axes > most)
      Fail(*table_.get("axes"), "axes has to be a whole number up to the region's " +
                                    std::to_string(region.inputs()) + " inputs");
    return static_cast<std::uint16_t>(axes);
  }

  const toml::array* Array(const char* key) const {
    const toml::node* node = table_.get(key);
    if (node != nullptr && !node->is_array()) Fail(*node, std::string(key) + " has to be a list");
    return node == nullptr ? nullptr : node->as_array();
  }

  std::uint16_t Index(const toml::node& node, const std::vector<ShortName>& names,
                      const char* noun) const {
    const std::string text = Text(node);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i].view() == text) return static_cast<std::uint16_t>(i);
    Fail(node, "there is no " + std::string(noun) + " \"" + text + "\" in the training data");
  }

  template <std::size_t N>
  void Indices(const char* key, const std::vector<ShortName>& names, const char* noun,
               InlineVector<std::uint16_t, N>& out) const {
    const toml::array* list = Array(key);
    if (list == nullptr) return;
    for (const toml::node& node : *list)
      if (!out.try_push(Index(node, names, noun)))
        Fail(node, std::string(key) + " holds at most " + std::to_string(N) + " names");
  }

  void ReadGaps(RegionConfig& region) const {
    const toml::array* list = Array("gaps");
    if (list == nullptr) return;
    for (const toml::node& node : *list) {
      const toml::array* pair = node.as_array();
      if (pair == nullptr || pair->size() != 2)
        Fail(node, "a gap is a pair of markers: the upper and the lower one");
      const RegionConfig::Gap indices = {Index(*pair->get(0), training_.markers, "marker"),
                                         Index(*pair->get(1), training_.markers, "marker")};
      if (!region.gaps.try_push(indices))
        Fail(node, "at most " + std::to_string(kMaxRegionGaps) + " gaps fit");
    }
  }

  const std::filesystem::path& path_;
  const toml::table& table_;
  const app::TrainingSet& training_;
};

void CheckThatEveryTargetIsInOneRegion(const std::filesystem::path& path,
                                       const app::TrainingSet& training,
                                       const std::vector<RegionConfig>& regions) {
  for (std::size_t i = 0; i < training.signals.size(); ++i) {
    std::size_t uses = 0;
    for (const RegionConfig& region : regions)
      uses += static_cast<std::size_t>(std::ranges::count(region.outputs, i));
    if (uses != 1)
      throw app::BadInput(path.string() + ": target \"" + std::string(training.signals[i].view()) +
                          "\" is in " + std::to_string(uses) +
                          " regions; every target belongs in exactly one");
  }
}

}  // namespace

retarget::Method ParseMethod(std::string_view name, const std::string& where) {
  return Parse(kMethods, name, where);
}

rbf::Kernel ParseKernel(std::string_view name, const std::string& where) {
  return Parse(kKernels, name, where);
}

rbf::Tail ParseTail(std::string_view name, const std::string& where) {
  return Parse(kTails, name, where);
}

float ParseEpsilon(std::string_view text, const std::string& where) {
  if (text == "auto") return rbf::kAutomaticEpsilon;
  if (text == "mean") return rbf::kMeanDistanceEpsilon;
  float epsilon = 0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, epsilon);
  if (error != std::errc{} || parsed != end || !std::isfinite(epsilon) || epsilon <= 0)
    throw app::BadInput(where + "\"" + std::string(text) +
                        "\" is neither auto nor mean nor a positive number");
  return epsilon;
}

std::vector<RegionConfig> ReadRegions(const std::filesystem::path& path,
                                      const app::TrainingSet& training,
                                      const RegionConfig& defaults) {
  if (!std::filesystem::is_regular_file(path))
    throw app::BadInput(path.string() + ": there is no such file");
  toml::table file;
  try {
    file = toml::parse_file(path.string());
  } catch (const toml::parse_error& error) {
    throw app::BadInput(path.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                        std::string(error.description()));
  }
  for (const auto& [key, node] : file)
    if (key.str() != "region")
      throw app::BadInput(path.string() + ":" + std::to_string(node.source().begin.line) +
                          ": unknown key \"" + std::string(key.str()) + "\"; expected [[region]]");
  const toml::array* list = file["region"].as_array();
  if (list == nullptr || list->empty())
    throw app::BadInput(path.string() + ": no regions; expected [[region]]");
  std::vector<RegionConfig> regions;
  for (const toml::node& node : *list) {
    const toml::table* table = node.as_table();
    if (table == nullptr)
      throw app::BadInput(path.string() + ": region has to be written as [[region]]");
    regions.push_back(RegionReader(path, *table, training).Read(defaults));
  }
  CheckThatEveryTargetIsInOneRegion(path, training, regions);
  return regions;
}

RegionConfig WholeFace(const app::TrainingSet& training, const RegionConfig& defaults) {
  RegionConfig region = defaults;
  region.name = ShortName::From("face").value_or(ShortName{});
  bool fits = true;
  for (std::size_t i = 0; i < training.markers.size(); ++i)
    fits = fits && region.points.try_push(static_cast<std::uint16_t>(i));
  for (std::size_t i = 0; i < training.signals.size(); ++i)
    fits = fits && region.outputs.try_push(static_cast<std::uint16_t>(i));
  if (!fits)
    throw app::BadInput("a profile holds at most " + std::to_string(kMaxMarkers) + " markers and " +
                        std::to_string(kMaxSignals) + " targets; there are " +
                        std::to_string(training.markers.size()) + " and " +
                        std::to_string(training.signals.size()) +
                        "; --regions reads some of them, and record --markers keeps some");
  if (region.axes > region.inputs())
    throw app::BadInput("--axes: " + std::to_string(region.axes) + " is more than the " +
                        std::to_string(region.inputs()) + " coordinates of the markers");
  return region;
}

}  // namespace facewire::tools
