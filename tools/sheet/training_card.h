#ifndef FACEWIRE_TOOLS_SHEET_TRAINING_CARD_H_
#define FACEWIRE_TOOLS_SHEET_TRAINING_CARD_H_

#include <opencv2/core.hpp>
#include <span>

#include "tools/sheet/canvas.h"
#include "tools/sheet/training_view.h"

namespace facewire::tools {

inline constexpr double kTrainingCardWidth = 505;
inline constexpr double kTrainingCardHeight = 228;

// Where markers go on a card: the same for every card, so that faces can be compared.
class FaceFrame {
 public:
  // Large enough for the face at rest and the shown rows.
  FaceFrame(const TrainingView& view, std::span<const std::size_t> shown);
  cv::Point2d At(cv::Point2d cm, cv::Point2d corner) const;

 private:
  cv::Point2d centre_;
  double px_per_cm_ = 1;
};

// A row of a training set: its markers over those of the face at rest, and its telling targets
// beside what the other rows predict.
void DrawTrainingCard(const TrainingView& view, std::size_t row, const FaceFrame& frame,
                      cv::Point2d corner, Canvas& canvas);

// What the marks of a card mean, in one line around the height `middle`.
void DrawTrainingLegend(double middle, Canvas& canvas);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_TRAINING_CARD_H_
