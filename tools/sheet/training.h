#ifndef FACEWIRE_TOOLS_SHEET_TRAINING_H_
#define FACEWIRE_TOOLS_SHEET_TRAINING_H_

#include <cstddef>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

namespace facewire::tools {

// A training set, and how well each of its rows is foretold by the others. All borrowed, by rows.
struct TrainingPicture {
  std::size_t rows = 0;
  std::size_t neutral_row = 0;           // from 0: the face at rest
  std::span<const std::string> signals;  // names of the targets
  std::span<const float> samples_cm;     // rows x 3 markers: x y z, head frame
  std::span<const float> targets;        // rows x signals
  std::span<const float> leave_one_out;  // rows x signals: target minus what the others predict
};

// The error of a row over all targets: root mean square, each in parts of the target's range in the
// training.
std::vector<double> RowErrors(const TrainingPicture& training);

// The `count` rows (from 0, rising) that are worth a card when not all can have one: the face at
// rest, and those with the largest error.
std::vector<std::size_t> WorstRows(const TrainingPicture& training, std::size_t count);

// Draws a contact sheet, kSheetWidthPx wide: the error of every row and of every target, then a
// card for each row of `shown` (from 0; numbered from 1 in the picture, as `facewire train`
// counts): the markers over those of the face at rest, and bars of the targets that matter in this
// row beside what the other rows predict. `subtitle` says what is shown. The result is 8-bit BGR.
cv::Mat DrawTrainingSheet(const std::string& subtitle, const TrainingPicture& training,
                          std::span<const std::size_t> shown);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_TRAINING_H_
