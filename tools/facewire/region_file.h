#ifndef FACEWIRE_TOOLS_FACEWIRE_REGION_FILE_H_
#define FACEWIRE_TOOLS_FACEWIRE_REGION_FILE_H_

#include <filesystem>
#include <vector>

#include "app/profile_file.h"
#include "core/retarget/training.h"

namespace facewire::tools {

// Stands in smoothing, tail smoothing and ridge for: to be chosen (tools/facewire/settings.h).
inline constexpr float kAutomatic = -1;

// How a face is divided for training (described in tools/facewire/train.md), for the markers and
// signals of `training`. What a region does not set comes from `defaults` (axes at most as many as
// the region has inputs).
// BadInput, one line with file and line: not TOML, unknown keys, markers, targets or kernels,
// numbers out of range, a target in no region or in two.
std::vector<retarget::RegionConfig> ReadRegions(const std::filesystem::path& path,
                                                const app::TrainingSet& training,
                                                const retarget::RegionConfig& defaults);

// One region that reads every marker and gives every signal.
// BadInput: more markers or signals than a profile holds, more axes than coordinates.
retarget::RegionConfig WholeFace(const app::TrainingSet& training,
                                 const retarget::RegionConfig& defaults);

// Names of methods, kernels and tails on the command line and in region files. BadInput: `where`,
// and the names that would be right.
retarget::Method ParseMethod(std::string_view name, const std::string& where);
rbf::Kernel ParseKernel(std::string_view name, const std::string& where);
rbf::Tail ParseTail(std::string_view name, const std::string& where);
// "auto", "mean" or a positive number, as RbfConfig::epsilon.
float ParseEpsilon(std::string_view text, const std::string& where);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_REGION_FILE_H_
