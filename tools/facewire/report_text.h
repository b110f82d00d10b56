#ifndef FACEWIRE_TOOLS_FACEWIRE_REPORT_TEXT_H_
#define FACEWIRE_TOOLS_FACEWIRE_REPORT_TEXT_H_

#include <optional>
#include <string>
#include <string_view>

namespace facewire::tools {

// The service's report (app/README.md) in a few lines for a person; nothing when it is no JSON
// object. What a later service adds is left out, what an older one does not know shows as "?".
std::optional<std::string> ReportText(std::string_view json);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_REPORT_TEXT_H_
