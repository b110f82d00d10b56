#ifndef FACEWIRE_TOOLS_MARKERS_TEXT_H_
#define FACEWIRE_TOOLS_MARKERS_TEXT_H_

#include <optional>
#include <string_view>
#include <vector>

namespace facewire::tools::markers {

// Without spaces, carriage returns, quotes and NULs around it.
std::string_view Trim(std::string_view text);
// The lines of a text, without their ends.
std::vector<std::string_view> Lines(std::string_view text);
// The fields of a line, trimmed; "a,,b" has three.
std::vector<std::string_view> Fields(std::string_view line, char separator);
// A number that is the whole field; NaN for an empty field or "nan"; nullopt for anything else.
std::optional<double> NumberOrGap(std::string_view field);

}  // namespace facewire::tools::markers

#endif  // FACEWIRE_TOOLS_MARKERS_TEXT_H_
