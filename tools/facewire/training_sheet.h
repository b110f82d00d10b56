#ifndef FACEWIRE_TOOLS_FACEWIRE_TRAINING_SHEET_H_
#define FACEWIRE_TOOLS_FACEWIRE_TRAINING_SHEET_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace facewire::tools {

// A contact sheet of the example pairs in a profile (tools/sheet/training.h). `rows`: "A:B", rows A
// to B, counted from 1 as `facewire train` counts; nullopt: all, or, when they are too many for one
// picture, the face at rest and the worst. Throws BadInput.
cv::Mat SheetOfTraining(const std::string& profile, const std::optional<std::string>& rows);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_TRAINING_SHEET_H_
