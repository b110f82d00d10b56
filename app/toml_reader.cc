#include "app/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "app/error.h"

namespace facewire::app {
namespace {

std::string Place(const std::string& file, std::uint32_t line, std::uint32_t column) {
  if (line == 0) return file + ": ";
  return file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

// Insertions, deletions and replacements between two words, letters of either case being equal.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                        std::tolower(static_cast<unsigned char>(b[j - 1]));
      const std::size_t replaced = diagonal + (same ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string_view TypeName(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

std::string Bounds(const NumberRange& range) {
  return Printed(range.min) + " to " + Printed(range.max) +
         (range.unit.empty() ? "" : " " + std::string(range.unit));
}

}  // namespace

void Problems::Add(const toml::source_region& where, const std::string& what) {
  found_.push_back({where.begin.line, where.begin.column, what});
}

void Problems::ThrowIfAny() const {
  if (found_.empty()) return;
  std::vector<Problem> sorted = found_;
  std::ranges::stable_sort(sorted, [](const Problem& a, const Problem& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  std::string text;
  for (const Problem& problem : sorted) {
    if (!text.empty()) text += '\n';
    text += Place(file_, problem.line, problem.column) + problem.text;
  }
  throw BadInput(text);
}

toml::table ParseTomlFile(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw BadInput(file.string() + ": is a folder; expected a TOML file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw BadInput(file.string() + ": cannot be read; check the path and its permissions");
  try {
    return toml::parse(in, file.string());
  } catch (const toml::parse_error& e) {
    const toml::source_position at = e.source().begin;
    throw BadInput(Place(file.string(), at.line, at.column) +
                   "not valid TOML: " + std::string(e.description()));
  }
}

std::string Printed(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string Suggestion(std::string_view written, const std::vector<std::string>& candidates) {
  const std::string* nearest = nullptr;
  std::size_t nearest_distance = std::max<std::size_t>(1, written.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = EditDistance(written, candidate);
    if (distance >= nearest_distance) continue;
    nearest = &candidate;
    nearest_distance = distance;
  }
  return nearest == nullptr ? "" : "; did you mean \"" + *nearest + "\"?";
}

TableReader::TableReader(Problems& problems, const toml::table* table, std::string path)
    : problems_(problems), table_(table), path_(std::move(path)) {}

const toml::node* TableReader::Find(std::string_view key) {
  if (std::ranges::find(known_, key) == known_.end()) known_.emplace_back(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

bool TableReader::Has(std::string_view key) const {
  return table_ != nullptr && table_->contains(key);
}

toml::source_region TableReader::Where(std::string_view key) const {
  if (table_ == nullptr) return {};
  const toml::node* node = table_->get(key);
  return node == nullptr ? table_->source() : node->source();
}

std::string TableReader::Path(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

bool TableReader::IsText(std::string_view key) const {
  return Has(key) && table_->get(key)->is_string();
}

void TableReader::Problem(std::string_view key, const std::string& what) {
  ProblemAt(Where(key), key, what);
}

void TableReader::ProblemAt(const toml::source_region& where, std::string_view key,
                            const std::string& what) {
  problems_.Add(where, Path(key) + ": " + what);
}

void TableReader::WrongType(std::string_view key, const toml::node& node, std::string_view wanted) {
  problems_.Add(node.source(), Path(key) + ": is " + std::string(TypeName(node)) + "; expected " +
                                   std::string(wanted));
}

bool TableReader::ReadNumber(const std::string& name, const toml::node& node,
                             const NumberRange& range, float& value) {
  const auto number = node.is_number() ? node.value<double>() : std::nullopt;
  if (!number) {
    problems_.Add(node.source(),
                  name + ": is " + std::string(TypeName(node)) + "; expected a number");
    return false;
  }
  if (!std::isfinite(*number) || *number < range.min || *number > range.max) {
    problems_.Add(node.source(),
                  name + ": " + Printed(*number) + " is out of range; allowed: " + Bounds(range));
    return false;
  }
  value = static_cast<float>(*number);
  return true;
}

void TableReader::Number(std::string_view key, float& value, const NumberRange& range) {
  if (const toml::node* node = Find(key)) ReadNumber(Path(key), *node, range, value);
}

void TableReader::Numbers(std::string_view key, float* values, std::size_t count,
                          const NumberRange& range) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count) {
    return WrongType(key, *node, "an array of " + std::to_string(count) + " numbers");
  }
  for (std::size_t i = 0; i < count; ++i) {
    ReadNumber(Path(key) + "[" + std::to_string(i) + "]", *array->get(i), range, values[i]);
  }
}

void TableReader::Integer(std::string_view key, int& value, int min, int max,
                          std::string_view unit) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  if (!node->is_integer()) return WrongType(key, *node, "a whole number");
  float checked = 0;
  const NumberRange range{static_cast<double>(min), static_cast<double>(max), unit};
  if (!ReadNumber(Path(key), *node, range, checked)) return;
  value = static_cast<int>(*node->value<std::int64_t>());
}

void TableReader::Milliseconds(std::string_view key, Duration& value, int max_ms) {
  int ms = static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(value).count());
  Integer(key, ms, 0, max_ms, "ms");
  value = std::chrono::milliseconds(ms);
}

void TableReader::Flag(std::string_view key, bool& value) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) return WrongType(key, *node, "true or false");
  value = *node->value<bool>();
}

void TableReader::Text(std::string_view key, std::string& value) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  if (!node->is_string()) return WrongType(key, *node, "a text");
  value = *node->value<std::string>();
}

bool TableReader::Name(std::string_view key, ShortName& value) {
  if (Find(key) == nullptr) return false;
  std::string text;
  Text(key, text);
  const auto made = ShortName::From(text);
  if (made) {
    value = *made;
  } else {
    Problem(key, "\"" + text + "\" is no name; expected 1 to " + std::to_string(kMaxNameLength) +
                     " printable ASCII characters without spaces");
  }
  return made.has_value();
}

std::size_t TableReader::ChoiceIndex(std::string_view key, const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "\"" : ", \"") + name + "\"";
  const toml::node* node = Find(key);
  if (node == nullptr) return names.size();
  if (!node->is_string()) {
    WrongType(key, *node, "one of " + all);
    return names.size();
  }
  const std::string value = *node->value<std::string>();
  const auto at = std::ranges::find(names, value);
  if (at == names.end()) {
    Problem(key, "\"" + value + "\" is none of " + all + Suggestion(value, names));
  }
  return static_cast<std::size_t>(at - names.begin());
}

TableReader TableReader::Table(std::string_view key) {
  const toml::node* node = Find(key);
  if (node != nullptr && !node->is_table()) WrongType(key, *node, "a table");
  return {problems_, node == nullptr ? nullptr : node->as_table(), Path(key)};
}

void TableReader::EachTable(std::string_view key, const std::function<void(TableReader&)>& each) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    if (array != nullptr && array->empty()) return;
    return WrongType(key, *node, "tables ([[" + Path(key) + "]])");
  }
  for (std::size_t i = 0; i < array->size(); ++i) {
    TableReader reader(problems_, array->get(i)->as_table(),
                       Path(key) + "[" + std::to_string(i) + "]");
    each(reader);
  }
}

void TableReader::EachNumber(
    std::string_view key,
    const std::function<void(std::string_view, double, const toml::source_region&)>& each) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const toml::table* table = node->as_table();
  if (table == nullptr) return WrongType(key, *node, "a table of numbers");
  std::vector<std::pair<toml::source_position, const toml::key*>> order;
  for (const auto& [name, value] : *table) order.emplace_back(name.source().begin, &name);
  std::ranges::sort(order, [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [at, name] : order) {
    const toml::node& value = *table->get(name->str());
    float number = 0;
    if (!ReadNumber(Path(key) + "." + std::string(name->str()), value, {}, number)) continue;
    each(name->str(), static_cast<double>(number), name->source());
  }
}

bool TableReader::EachPair(
    std::string_view key, const NumberRange& range,
    const std::function<void(float, float, const toml::source_region&)>& each) {
  const toml::node* node = Find(key);
  if (node == nullptr) return true;
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    WrongType(key, *node, "an array of pairs, as [[0, 0], [1, 1]]");
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string name = Path(key) + "[" + std::to_string(i) + "]";
    const toml::array* pair = array->get(i)->as_array();
    float first = 0;
    float second = 0;
    if (pair == nullptr || pair->size() != 2) {
      problems_.Add(array->get(i)->source(), name + ": expected a pair of numbers, as [0, 0]");
      good = false;
    } else if (ReadNumber(name + "[0]", *pair->get(0), range, first) &&
               ReadNumber(name + "[1]", *pair->get(1), range, second)) {
      each(first, second, pair->source());
    } else {
      good = false;
    }
  }
  return good;
}

bool TableReader::Require(std::string_view key, std::string_view what_it_is) {
  if (Find(key) != nullptr) return true;
  problems_.Add(table_ == nullptr ? toml::source_region{} : table_->source(),
                (path_.empty() ? "" : path_ + ": ") + "\"" + std::string(key) +
                    "\" is missing: " + std::string(what_it_is));
  return false;
}

void TableReader::Finish() {
  if (table_ == nullptr) return;
  for (const auto& [name, value] : *table_) {
    const std::string key(name.str());
    if (std::ranges::find(known_, key) != known_.end()) continue;
    std::string hint = Suggestion(key, known_);
    if (hint.empty()) {
      for (const std::string& known : known_) hint += (hint.empty() ? "; known: " : ", ") + known;
    }
    problems_.Add(name.source(), "unknown key \"" + Path(key) + "\"" + hint);
  }
}

}  // namespace facewire::app
