#include "tools/sheet/training.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "tools/sheet/canvas.h"
#include "tools/sheet/head.h"
#include "tools/sheet/training_card.h"
#include "tools/sheet/training_view.h"

namespace facewire::tools {
namespace {

// All lengths in pixels of the finished sheet.
constexpr double kGap = 14;
constexpr double kInset = 16;
constexpr double kWidth = kSheetWidthPx - 2 * kMargin;
constexpr double kRowPanelHeight = 150;
constexpr double kLegendHeight = 40;
constexpr std::size_t kTargetColumns = 3;
constexpr double kTargetPitch = 19;
constexpr double kTargetHeading = 48;
constexpr double kThick = 8;
constexpr std::size_t kCardColumns = 3;
static_assert(kCardColumns * kTrainingCardWidth + (kCardColumns - 1) * kGap <= kWidth);
constexpr std::size_t kNamedRows = 8;  // of the worst, when not all have space for their number

std::vector<double> RowErrorsOf(const TrainingView& view) {
  std::vector<double> errors(view.rows());
  for (std::size_t row = 0; row < errors.size(); ++row) errors[row] = view.row_error(row);
  return errors;
}

// A thin bar for each row: the shown ones dark, the worst with their numbers.
void DrawRowErrors(const std::vector<double>& errors, std::span<const std::size_t> shown, double y,
                   Canvas& canvas) {
  canvas.Box({kMargin, y, kWidth, kRowPanelHeight}, 10, palette::kCard);
  const double greatest = std::max(*std::ranges::max_element(errors), 1e-9);
  canvas.Text("error of each row", {kMargin + kInset, y + 28}, 11, palette::kInk, Align::kLeft,
              true);
  canvas.Text("over all targets, root mean square, in % of each target's range; highest " +
                  Number("%.1f %%", 100 * greatest),
              {kMargin + kInset + 160, y + 28}, kSmall, palette::kMuted);
  const double left = kMargin + kInset;
  const double width = kWidth - 2 * kInset;
  const double bottom = y + kRowPanelHeight - 14;
  constexpr double kHighest = 70;
  const double pitch = width / static_cast<double>(errors.size());
  const double thick = std::clamp(pitch * 0.7, 0.75, 40.0);
  const auto middle = [&](std::size_t row) {
    return left + pitch * (static_cast<double>(row) + 0.5);
  };
  for (std::size_t row = 0; row < errors.size(); ++row) {
    const double high = std::max(1.0, kHighest * errors[row] / greatest);
    canvas.Box({middle(row) - thick / 2, bottom - high, thick, high}, 0,
               std::ranges::binary_search(shown, row) ? palette::kParameter : palette::kMuted);
  }
  std::vector<std::size_t> worst(errors.size());
  std::iota(worst.begin(), worst.end(), std::size_t{0});
  std::ranges::stable_sort(worst, std::greater{}, [&](std::size_t row) { return errors[row]; });
  std::vector<double> taken;  // places of the numbers
  constexpr double kApart = 30;
  for (const std::size_t row : worst) {
    const bool is_free =
        std::ranges::none_of(taken, [&](double x) { return std::abs(x - middle(row)) < kApart; });
    if ((pitch < kApart && taken.size() == kNamedRows) || !is_free) continue;
    canvas.Text(std::to_string(row + 1),
                {middle(row), bottom - kHighest * errors[row] / greatest - 5}, kSmall,
                palette::kInk, Align::kCentre);
    taken.push_back(middle(row));
  }
}

double TargetPanelHeight(const TrainingView& view) {
  const std::size_t lines = (view.signals() + kTargetColumns - 1) / kTargetColumns;
  return kTargetHeading + static_cast<double>(lines) * kTargetPitch + 12;
}

// A line for each target: name, bar of the root mean square with the worst row as a tick.
void DrawTargetErrors(const TrainingView& view, double y, Canvas& canvas) {
  canvas.Box({kMargin, y, kWidth, TargetPanelHeight(view)}, 10, palette::kCard);
  canvas.Text("error of each target", {kMargin + kInset, y + 28}, 11, palette::kInk, Align::kLeft,
              true);
  canvas.Text(
      "over all rows, root mean square (bar) and worst (tick), in the target's own unit; "
      "the track is its range",
      {kMargin + kInset + 180, y + 28}, kSmall, palette::kMuted);
  const std::size_t lines = (view.signals() + kTargetColumns - 1) / kTargetColumns;
  for (std::size_t s = 0; s < view.signals(); ++s) {
    const std::size_t column = s / lines;
    double sum = 0;
    std::size_t worst = 0;
    for (std::size_t row = 0; row < view.rows(); ++row) {
      sum += view.error(row, s) * view.error(row, s);
      if (std::abs(view.error(row, s)) > std::abs(view.error(worst, s))) worst = row;
    }
    const double range = view.range(s).size();
    const double rms = std::sqrt(sum / static_cast<double>(view.rows()));
    const double most = std::abs(view.error(worst, s));
    const double x = kMargin + kInset + static_cast<double>(column) * (kWidth / kTargetColumns);
    const double at = y + kTargetHeading + (static_cast<double>(s % lines) + 0.5) * kTargetPitch;
    constexpr double kName = 176;
    constexpr double kTrack = 140;
    canvas.Text(view.name(s), {x, at + kSmall / 2}, kSmall, palette::kInk);
    canvas.Box({x + kName, at - kThick / 2, kTrack, kThick}, kThick / 2, palette::kLine);
    canvas.Box(
        {x + kName, at - kThick / 2, std::max(1.0, kTrack * std::min(1.0, rms / range)), kThick}, 2,
        palette::kParameter);
    canvas.Box({x + kName + kTrack * std::min(1.0, most / range) - 1, at - 6, 2.5, 12}, 1,
               palette::kInk);
    canvas.Text(ValueText(rms, range), {x + kName + kTrack + 44, at + kSmall / 2}, kSmall,
                palette::kInk, Align::kRight);
    canvas.Text(ValueText(most, range) + " in row " + std::to_string(worst + 1),
                {x + kName + kTrack + 54, at + kSmall / 2}, kSmall, palette::kMuted);
  }
}

std::vector<Figure> FiguresOf(const TrainingView& view, const std::vector<double>& errors) {
  double sum = 0;
  for (const double error : errors) sum += error * error;
  const auto worst = static_cast<std::size_t>(std::ranges::max_element(errors) - errors.begin());
  return {{std::to_string(view.rows()), "rows"},
          {std::to_string(view.markers()), "markers"},
          {std::to_string(view.signals()), "targets"},
          {Number("%.1f %%", 100 * std::sqrt(sum / static_cast<double>(errors.size()))),
           "error, root mean square of all"},
          {std::to_string(worst + 1), "row that the others predict worst"}};
}

}  // namespace

std::vector<double> RowErrors(const TrainingPicture& training) {
  return RowErrorsOf(TrainingView(training));
}

std::vector<std::size_t> WorstRows(const TrainingPicture& training, std::size_t count) {
  const std::vector<double> errors = RowErrors(training);
  std::vector<std::size_t> rows(training.rows);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::stable_sort(rows, std::greater{}, [&](std::size_t row) {
    return row == training.neutral_row ? std::numeric_limits<double>::infinity() : errors[row];
  });
  rows.resize(std::min(rows.size(), count));
  std::ranges::sort(rows);
  return rows;
}

cv::Mat DrawTrainingSheet(const std::string& subtitle, const TrainingPicture& training,
                          std::span<const std::size_t> shown) {
  const TrainingView view(training);
  const std::vector<double> errors = RowErrorsOf(view);
  const std::size_t lines = (shown.size() + kCardColumns - 1) / kCardColumns;
  const double top = kHeadHeight + kRowPanelHeight + kGap + TargetPanelHeight(view) + kLegendHeight;
  Canvas canvas(
      kSheetWidthPx,
      static_cast<int>(top + static_cast<double>(lines) * (kTrainingCardHeight + kGap) + kGap),
      palette::kPaper);
  DrawHead("a training set, and what the other rows predict for each row", FiguresOf(view, errors),
           canvas);
  canvas.Text(subtitle, {kSheetWidthPx - kMargin, 54}, 10, palette::kInk, Align::kRight);
  DrawRowErrors(errors, shown, kHeadHeight, canvas);
  DrawTargetErrors(view, kHeadHeight + kRowPanelHeight + kGap, canvas);
  DrawTrainingLegend(top - kLegendHeight / 2, canvas);
  const FaceFrame frame(view, shown);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::size_t line = i / kCardColumns;
    const cv::Point2d corner{
        kMargin + static_cast<double>(i % kCardColumns) * (kTrainingCardWidth + kGap),
        top + static_cast<double>(line) * (kTrainingCardHeight + kGap)};
    DrawTrainingCard(view, shown[i], frame, corner, canvas);
  }
  return canvas.Finish();
}

}  // namespace facewire::tools
