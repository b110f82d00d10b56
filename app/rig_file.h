#ifndef FACEWIRE_APP_RIG_FILE_H_
#define FACEWIRE_APP_RIG_FILE_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rig/rig.h"

namespace facewire::app {

// Reads a rig (rig.toml; the format is described in app/README.md and shown by
// app/share/otto.toml). A drive must name one of `known_signals`, the head's own signals apart,
// which are always known; null: any name passes. Throws BadInput with every problem on a line of
// its own, "FILE:LINE:COLUMN: what is wrong; what would be right".
Rig LoadRig(const std::filesystem::path& file,
            const std::vector<std::string>* known_signals = nullptr);

// The index of a landmark with a name of its own ("chin", "left_mouth_corner"), else nullopt.
// Left and right are the person's own.
std::optional<std::int16_t> LandmarkByName(std::string_view name);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_RIG_FILE_H_
