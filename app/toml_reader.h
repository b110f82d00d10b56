#ifndef FACEWIRE_APP_TOML_READER_H_
#define FACEWIRE_APP_TOML_READER_H_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/name.h"
#include "core/base/time.h"

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

namespace facewire::app {

// What is wrong with one file, each with its place, in the order of the file.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  // `what` says what is wrong and what would be right; the place (line 0: the file as a whole) is
  // put in front.
  void Add(const toml::source_region& where, const std::string& what);
  bool empty() const { return found_.empty(); }
  // Throws BadInput with one line a problem, unless there is none.
  void ThrowIfAny() const;

 private:
  struct Problem {
    std::uint32_t line = 0;
    std::uint32_t column = 0;
    std::string text;
  };
  std::string file_;
  std::vector<Problem> found_;
};

// The file as a table. Throws BadInput: missing, unreadable, not TOML (with its place).
toml::table ParseTomlFile(const std::filesystem::path& file);

// The candidate that a person may have meant, as `; did you mean "x"?`, or "" when none is near.
std::string Suggestion(std::string_view written, const std::vector<std::string>& candidates);

struct NumberRange {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  std::string_view unit{};  // for the message only
};

// As messages show a number: 0.5, 1500, 1e+06.
std::string Printed(double number);

// Reads one table of a TOML file into plain variables. A key that is absent leaves its variable as
// it is; whatever is wrong becomes a problem and leaves the variable, too. Finish reports the keys
// that nobody asked for.
class TableReader {
 public:
  // `table` may be null: absent. `path` names it in messages ("camera.replay"; "" for the file).
  TableReader(Problems& problems, const toml::table* table, std::string path);

  void Number(std::string_view key, float& value, const NumberRange& range);
  void Integer(std::string_view key, int& value, int min, int max, std::string_view unit = "");
  void Milliseconds(std::string_view key, Duration& value, int max_ms);
  void Flag(std::string_view key, bool& value);
  void Text(std::string_view key, std::string& value);
  // False when a problem was reported, or the key is absent.
  bool Name(std::string_view key, ShortName& value);
  // An array of exactly `count` numbers.
  void Numbers(std::string_view key, float* values, std::size_t count, const NumberRange& range);
  template <class T>
  void Choice(std::string_view key, T& value,
              const std::vector<std::pair<std::string_view, T>>& choices) {
    std::vector<std::string> names;
    names.reserve(choices.size());
    for (const auto& choice : choices) names.emplace_back(choice.first);
    const std::size_t at = ChoiceIndex(key, names);
    if (at < choices.size()) value = choices[at].second;
  }

  // A table inside; absent ones read as empty.
  TableReader Table(std::string_view key);
  // Calls `each` for every table of an array of tables ([[key]]).
  void EachTable(std::string_view key, const std::function<void(TableReader&)>& each);
  // Calls `each` for every key = number of a table, in the order of the file.
  void EachNumber(
      std::string_view key,
      const std::function<void(std::string_view, double, const toml::source_region&)>& each);
  // Calls `each` for every pair of an array of pairs of numbers ([[0, 0], [1, 1]]), each number
  // within `range`. False when a problem was reported.
  bool EachPair(std::string_view key, const NumberRange& range,
                const std::function<void(float, float, const toml::source_region&)>& each);

  bool Has(std::string_view key) const;
  bool IsText(std::string_view key) const;
  toml::source_region Where(std::string_view key) const;        // of the value, else of the table
  void Problem(std::string_view key, const std::string& what);  // about the value of that key
  void ProblemAt(const toml::source_region& where, std::string_view key, const std::string& what);
  // Reports an absent key.
  bool Require(std::string_view key, std::string_view what_it_is);
  // A key that is another reader's.
  void Leave(std::string_view key) { (void)Find(key); }
  void Finish();

 private:
  const toml::node* Find(std::string_view key);
  void WrongType(std::string_view key, const toml::node& node, std::string_view wanted);
  bool ReadNumber(const std::string& name, const toml::node& node, const NumberRange& range,
                  float& value);
  std::size_t ChoiceIndex(std::string_view key, const std::vector<std::string>& names);
  std::string Path(std::string_view key) const;

  Problems& problems_;
  const toml::table* table_;
  std::string path_;
  std::vector<std::string> known_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_TOML_READER_H_
