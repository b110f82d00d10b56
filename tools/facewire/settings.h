#ifndef FACEWIRE_TOOLS_FACEWIRE_SETTINGS_H_
#define FACEWIRE_TOOLS_FACEWIRE_SETTINGS_H_

#include <cstddef>
#include <string>

#include "app/profile_file.h"

namespace facewire::tools {

// Which settings of a region were chosen, and why.
struct Choice {
  enum class Reason {
    kGiven,        // there was nothing to choose
    kLeaveOneOut,  // the least leave-one-out error on a grid, then over epsilon
    // Most rows show a pose that no other row shows, so how well the others predict it says nothing
    // about smoothing; the mapping goes through every row, as straight as it can between them.
    kRowsStandAlone,
  };
  Reason reason = Reason::kGiven;
  float error = 0;   // rms leave-one-out error of the best setting, in the targets' units
  float spread = 0;  // rms of the targets around their means: the error of knowing nothing
};

// Replaces what is automatic in training.regions[region] (epsilon 0, kAutomatic of region_file.h)
// by numbers. Where even the best setting leaves more than 0.7 of the spread unexplained,
// leave-one-out errors are not trusted (kRowsStandAlone). What cannot be solved counts as bad;
// nothing is thrown for it here.
Choice ChooseSettings(app::TrainingSet& training, std::size_t region);

// One line for people.
std::string Describe(const retarget::RegionConfig& region, const Choice& choice);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SETTINGS_H_
