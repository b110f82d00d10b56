#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_NAMES_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_NAMES_H_

#include <set>
#include <string>
#include <string_view>

namespace facewire::tools::rig {

// Names of a rig file: short, printable, without blanks, and each there once.
class RigNames {
 public:
  // `name`, or what is left of it under those rules, in at most `longest` characters; a number
  // tells apart what would be the same.
  std::string Take(std::string_view name, std::string_view otherwise, std::size_t longest);

 private:
  std::set<std::string, std::less<>> taken_;
};

// A name out of a file, for a line of text: no control characters, and not without end.
std::string Shown(std::string_view name);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_NAMES_H_
