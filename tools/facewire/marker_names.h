#ifndef FACEWIRE_TOOLS_FACEWIRE_MARKER_NAMES_H_
#define FACEWIRE_TOOLS_FACEWIRE_MARKER_NAMES_H_

#include <cstddef>
#include <string>
#include <vector>

namespace facewire::tools {

// The index of each wanted name in `names`; all of them in their order when none is wanted. Throws
// BadInput, "PATH: WHO: there is no marker ..." with every name that is missing and what may have
// been meant.
std::vector<std::size_t> FindMarkers(const std::vector<std::string>& names,
                                     const std::vector<std::string>& wanted,
                                     const std::string& path, const std::string& who);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_MARKER_NAMES_H_
