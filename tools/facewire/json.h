#ifndef FACEWIRE_TOOLS_FACEWIRE_JSON_H_
#define FACEWIRE_TOOLS_FACEWIRE_JSON_H_

#include <cstdint>
#include <string>
#include <string_view>

// The little JSON that the commands write: one object a line, built by appending to a string.
namespace facewire::tools::json {

// A number with so many decimals, without trailing zeros ("-0" becomes "0"); null when it is not
// finite, for which JSON has no number.
void AppendNumber(std::string& out, double value, int decimals);
void AppendInteger(std::string& out, std::int64_t value);
// In quotes, with everything escaped that must be.
void AppendString(std::string& out, std::string_view text);

}  // namespace facewire::tools::json

#endif  // FACEWIRE_TOOLS_FACEWIRE_JSON_H_
