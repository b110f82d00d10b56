#ifndef FACEWIRE_TOOLS_FACEWIRE_JSON_READER_H_
#define FACEWIRE_TOOLS_FACEWIRE_JSON_READER_H_

#include <cstddef>
#include <optional>
#include <string_view>

namespace facewire::tools::json {

// Walks over a text of JSON that is borrowed, value by value: as much as reading one line of known
// shape needs. Every call skips the blanks before what it looks for; one that does not find it
// says so and stays where it is.
class Reader {
 public:
  explicit Reader(std::string_view text) noexcept : rest_(text) {}

  // One character of JSON's own: { } [ ] , :
  bool Take(char mark) noexcept;
  bool Null() noexcept;
  std::optional<double> Number() noexcept;
  // What is between the quotes, as it stands there: escapes are not resolved.
  std::optional<std::string_view> String() noexcept;
  // Any value, whatever is in it.
  bool Skip() noexcept;
  bool AtEnd() noexcept;

 private:
  static constexpr int kMaxDepth = 32;
  void SkipBlanks() noexcept;
  bool Word(std::string_view word) noexcept;
  bool Skip(int depth) noexcept;
  bool SkipList(char end, bool keys, int depth) noexcept;

  std::string_view rest_;
};

}  // namespace facewire::tools::json

#endif  // FACEWIRE_TOOLS_FACEWIRE_JSON_READER_H_
