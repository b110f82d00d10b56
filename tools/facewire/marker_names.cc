#include "tools/facewire/marker_names.h"

#include <algorithm>
#include <numeric>

#include "app/error.h"
#include "app/toml_reader.h"

namespace facewire::tools {

std::vector<std::size_t> FindMarkers(const std::vector<std::string>& names,
                                     const std::vector<std::string>& wanted,
                                     const std::string& path, const std::string& who) {
  std::vector<std::size_t> found;
  if (wanted.empty()) {
    found.resize(names.size());
    std::iota(found.begin(), found.end(), std::size_t{0});
    return found;
  }
  std::string missing;
  for (const std::string& name : wanted) {
    const auto at = std::ranges::find(names, name);
    if (at == names.end())
      missing += (missing.empty() ? "" : ", and no ") + name + app::Suggestion(name, names);
    found.push_back(static_cast<std::size_t>(at - names.begin()));
  }
  if (!missing.empty()) throw app::BadInput(path + ": " + who + ": there is no marker " + missing);
  return found;
}

}  // namespace facewire::tools
