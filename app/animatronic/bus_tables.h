#ifndef FACEWIRE_APP_ANIMATRONIC_BUS_TABLES_H_
#define FACEWIRE_APP_ANIMATRONIC_BUS_TABLES_H_

#include <filesystem>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "app/toml_reader.h"

namespace facewire::app {

// The [[bus]] tables of a configuration. What is wrong becomes a problem of `top`; relative paths
// are in `folder`.
std::vector<ServoBusConfig> ReadBuses(TableReader& top, const std::filesystem::path& folder);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_BUS_TABLES_H_
