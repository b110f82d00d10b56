#ifndef FACEWIRE_TOOLS_SHEET_TRAINING_VIEW_H_
#define FACEWIRE_TOOLS_SHEET_TRAINING_VIEW_H_

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/sheet/head.h"
#include "tools/sheet/training.h"

namespace facewire::tools {

// Of a target, over the rows.
struct TargetRange {
  double low = 0, high = 0;
  double size() const { return std::max(high - low, 1e-9); }
};

// A training set, read by row and target; borrows what the picture borrows.
class TrainingView {
 public:
  explicit TrainingView(const TrainingPicture& training)
      : t_(training), ranges_(training.signals.size()) {
    for (std::size_t s = 0; s < signals(); ++s) {
      ranges_[s] = {target(0, s), target(0, s)};
      for (std::size_t row = 1; row < t_.rows; ++row)
        ranges_[s] = {std::min(ranges_[s].low, target(row, s)),
                      std::max(ranges_[s].high, target(row, s))};
    }
  }

  std::size_t rows() const { return t_.rows; }
  std::size_t signals() const { return t_.signals.size(); }
  std::size_t markers() const { return t_.samples_cm.size() / t_.rows / 3; }
  std::size_t neutral_row() const { return t_.neutral_row; }
  const std::string& name(std::size_t signal) const { return t_.signals[signal]; }
  const TargetRange& range(std::size_t signal) const { return ranges_[signal]; }

  double target(std::size_t row, std::size_t signal) const {
    return static_cast<double>(t_.targets[row * signals() + signal]);
  }
  double error(std::size_t row, std::size_t signal) const {
    return static_cast<double>(t_.leave_one_out[row * signals() + signal]);
  }
  double prediction(std::size_t row, std::size_t signal) const {
    return target(row, signal) - error(row, signal);
  }
  double rest(std::size_t signal) const { return target(t_.neutral_row, signal); }
  // In parts of the target's range.
  double relative_error(std::size_t row, std::size_t signal) const {
    return error(row, signal) / ranges_[signal].size();
  }
  // Of the row, as RowErrors.
  double row_error(std::size_t row) const {
    double sum = 0;
    for (std::size_t s = 0; s < signals(); ++s)
      sum += relative_error(row, s) * relative_error(row, s);
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(signals(), 1)));
  }
  // From the front.
  cv::Point2d marker(std::size_t row, std::size_t marker) const {
    const auto xyz = t_.samples_cm.subspan((row * markers() + marker) * 3, 3);
    return {static_cast<double>(xyz[0]), static_cast<double>(xyz[1])};
  }

 private:
  const TrainingPicture t_;
  std::vector<TargetRange> ranges_;
};

// A value without more digits than its range deserves.
inline std::string ValueText(double value, double range) {
  const char* const format = range > 200 ? "%.0f" : range > 2 ? "%.1f" : "%.2f";
  return Number(format, std::abs(value) < 0.005 * range ? 0.0 : value);
}

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_TRAINING_VIEW_H_
