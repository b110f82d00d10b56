#ifndef FACEWIRE_TOOLS_FACEWIRE_TRAINING_FILES_H_
#define FACEWIRE_TOOLS_FACEWIRE_TRAINING_FILES_H_

#include <cstddef>
#include <string>
#include <vector>

#include "app/profile_file.h"
#include "core/base/name.h"

namespace facewire::tools {

// Named numbers, a row a sample. Of markers: x, y and z of each, in cm, by rows.
struct TrainingTable {
  std::vector<ShortName> names;
  std::vector<float> values;
  std::size_t rows = 0;
};

// Markers as tools/markers/take.h says for .csv, with nothing else in the file and no gaps. Throws
// BadInput, one line with file, line and marker; also for names that a profile cannot carry.
TrainingTable ReadSamples(const std::string& path);

// Any named numbers, one column each; "frame", "time", "time_s" and "t_us" are left out. Throws
// BadInput, one line with file, line and column: an empty field, a name twice or one that a profile
// cannot carry, and as tools/markers/table.h.
TrainingTable ReadTargets(const std::string& path);

// Leaves out the markers that no region reads: a whole recorded face has more than a profile holds.
void DropUnusedMarkers(app::TrainingSet& training);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_TRAINING_FILES_H_
