#include "tools/sheet/training.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numeric>

#include "tools/sheet/canvas.h"
#include "tools/sheet/head.h"

namespace facewire::tools {
namespace {

const cv::Scalar kAlarm{16, 72, 190};  // kParameter, dark enough for small letters

// All lengths in pixels of the finished sheet.
constexpr double kGap = 14;
constexpr double kInset = 16;
constexpr double kWidth = kSheetWidthPx - 2 * kMargin;
constexpr double kRowPanelHeight = 150;
constexpr double kLegendHeight = 40;
constexpr std::size_t kTargetColumns = 3;
constexpr double kTargetPitch = 19;
constexpr double kTargetHeading = 48;
constexpr std::size_t kCardColumns = 3;
constexpr double kCardWidth = (kWidth - (kCardColumns - 1) * kGap) / kCardColumns;
constexpr double kCardHeight = 228;
constexpr double kFaceWidth = 172;
constexpr double kFaceHeight = 176;
constexpr double kBarPitch = 20;
constexpr std::size_t kBars = 8;
constexpr double kThick = 8;
constexpr std::size_t kNamedRows = 8;  // of the worst, when not all have space for their number

// A target counts in a row when it, or what is predicted, is so far from rest; an error stands out
// from so much on. In parts of the target's range.
constexpr double kMatters = 0.05;
constexpr double kStandsOut = 0.1;

std::string Number(const char* format, double value) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

// A value without more digits than its range deserves.
std::string ValueText(double value, double range) {
  const char* const format = range > 200 ? "%.0f" : range > 2 ? "%.1f" : "%.2f";
  return Number(format, std::abs(value) < 0.005 * range ? 0.0 : value);
}

struct Range {
  double low = 0, high = 0;
  double size() const { return std::max(high - low, 1e-9); }
};

// The training, read by row and target.
class View {
 public:
  explicit View(const TrainingPicture& training) : t_(training), ranges_(training.signals.size()) {
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
  const Range& range(std::size_t signal) const { return ranges_[signal]; }

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
  // From the front.
  cv::Point2d marker(std::size_t row, std::size_t marker) const {
    const auto xyz = t_.samples_cm.subspan((row * markers() + marker) * 3, 3);
    return {static_cast<double>(xyz[0]), static_cast<double>(xyz[1])};
  }

 private:
  const TrainingPicture& t_;
  std::vector<Range> ranges_;
};

double RowError(const View& view, std::size_t row) {
  double sum = 0;
  for (std::size_t s = 0; s < view.signals(); ++s)
    sum += view.relative_error(row, s) * view.relative_error(row, s);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(view.signals(), 1)));
}

std::vector<double> RowErrorsOf(const View& view) {
  std::vector<double> errors(view.rows());
  for (std::size_t row = 0; row < errors.size(); ++row) errors[row] = RowError(view, row);
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

double TargetPanelHeight(const View& view) {
  const std::size_t lines = (view.signals() + kTargetColumns - 1) / kTargetColumns;
  return kTargetHeading + static_cast<double>(lines) * kTargetPitch + 12;
}

// A line for each target: name, bar of the root mean square with the worst row as a tick.
void DrawTargetErrors(const View& view, double y, Canvas& canvas) {
  canvas.Box({kMargin, y, kWidth, TargetPanelHeight(view)}, 10, palette::kCard);
  canvas.Text("error of each target", {kMargin + kInset, y + 28}, 11, palette::kInk, Align::kLeft,
              true);
  canvas.Text(
      "over all rows, root mean square (bar) and worst (tick), in the target's own unit; "
      "the track is its range",
      {kMargin + kInset + 180, y + 28}, kSmall, palette::kMuted);
  const std::size_t lines = (view.signals() + kTargetColumns - 1) / kTargetColumns;
  for (std::size_t s = 0; s < view.signals(); ++s) {
    double sum = 0;
    std::size_t worst = 0;
    for (std::size_t row = 0; row < view.rows(); ++row) {
      sum += view.error(row, s) * view.error(row, s);
      if (std::abs(view.error(row, s)) > std::abs(view.error(worst, s))) worst = row;
    }
    const double range = view.range(s).size();
    const double rms = std::sqrt(sum / static_cast<double>(view.rows()));
    const double most = std::abs(view.error(worst, s));
    const double x = kMargin + kInset + static_cast<double>(s / lines) * (kWidth / kTargetColumns);
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

void DrawLegend(double y, Canvas& canvas) {
  double x = kMargin;
  const double middle = y + kLegendHeight / 2;
  const auto label = [&](const char* text) {
    canvas.Text(text, {x, middle + kSmall / 2}, kSmall, palette::kMuted);
    x += Canvas::TextWidth(text, kSmall) + 34;
  };
  canvas.Disc({x + 4, middle}, 3, palette::kMuted);
  x += 14;
  label("marker at rest");
  const std::array line{cv::Point2d{x, middle}, cv::Point2d{x + 18, middle}};
  canvas.Stroke(line, palette::kBone, 1.5);
  canvas.Disc(line[1], 3, palette::kInk);
  x += 28;
  label("where it goes");
  canvas.Box({x, middle - kThick / 2, 26, kThick}, 2, palette::kBone);
  x += 34;
  label("target");
  canvas.Box({x, middle - 7, 2.5, 14}, 1, palette::kInk);
  x += 10;
  label("what the other rows predict");
  canvas.Box({x, middle - 2, 26, 4}, 1, palette::kParameter);
  x += 34;
  label("the error between them");
}

// Where markers go on a card: the same for every card, so that faces can be compared.
class FaceFrame {
 public:
  FaceFrame(const View& view, std::span<const std::size_t> shown) {
    cv::Point2d low = view.marker(view.neutral_row(), 0);
    cv::Point2d high = low;
    const auto include = [&](std::size_t row) {
      for (std::size_t m = 0; m < view.markers(); ++m) {
        const cv::Point2d p = view.marker(row, m);
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    };
    include(view.neutral_row());
    for (const std::size_t row : shown) include(row);
    constexpr double kAir = 12;
    centre_ = (low + high) * 0.5;
    px_per_cm_ = std::min((kFaceWidth - 2 * kAir) / std::max(high.x - low.x, 1e-6),
                          (kFaceHeight - 2 * kAir) / std::max(high.y - low.y, 1e-6));
  }

  cv::Point2d At(cv::Point2d cm, cv::Point2d corner) const {
    return {corner.x + kFaceWidth / 2 + px_per_cm_ * (cm.x - centre_.x),
            corner.y + kFaceHeight / 2 - px_per_cm_ * (cm.y - centre_.y)};
  }

 private:
  cv::Point2d centre_;
  double px_per_cm_ = 1;
};

void DrawFace(const View& view, std::size_t row, const FaceFrame& frame, cv::Point2d corner,
              Canvas& canvas) {
  canvas.Box({corner.x, corner.y, kFaceWidth, kFaceHeight}, 6, palette::kPaper);
  const double dot = view.markers() > 60 ? 1.3 : 2.2;
  const auto at = [&](std::size_t r, std::size_t m) { return frame.At(view.marker(r, m), corner); };
  for (std::size_t m = 0; m < view.markers(); ++m)
    canvas.Disc(at(view.neutral_row(), m), dot, palette::kMuted);
  if (row == view.neutral_row()) return;
  for (std::size_t m = 0; m < view.markers(); ++m) {
    const std::array line{at(view.neutral_row(), m), at(row, m)};
    if (cv::norm(line[1] - line[0]) < 0.75) continue;  // did not move
    canvas.Stroke(line, palette::kBone, 1.0);
    canvas.Disc(line[1], dot, palette::kInk);
  }
}

// The targets that matter in a row, the most moved ones first chosen, in the training's order.
// `left_out`: how many more there are.
std::vector<std::size_t> Telling(const View& view, std::size_t row, std::size_t& left_out) {
  std::vector<std::pair<double, std::size_t>> by_motion;
  for (std::size_t s = 0; s < view.signals(); ++s) {
    const double target = std::abs(view.target(row, s) - view.rest(s)) / view.range(s).size();
    const double predicted =
        std::abs(view.prediction(row, s) - view.rest(s)) / view.range(s).size();
    if (std::max(target, predicted) >= kMatters)
      by_motion.emplace_back(-std::max(target, predicted), s);
  }
  std::ranges::stable_sort(by_motion);
  left_out = by_motion.size() - std::min(by_motion.size(), kBars);
  by_motion.resize(std::min(by_motion.size(), kBars));
  std::vector<std::size_t> signals;
  for (const auto& [motion, signal] : by_motion) signals.push_back(signal);
  std::ranges::sort(signals);
  return signals;
}

void DrawBar(const View& view, std::size_t row, std::size_t signal, cv::Point2d at,
             Canvas& canvas) {
  constexpr double kName = 132;
  constexpr double kTrack = 74;
  const double target = view.target(row, signal);
  const double predicted = view.prediction(row, signal);
  const Range& range = view.range(signal);
  const auto x_of = [&](double value) {
    return at.x + kName + kTrack * std::clamp((value - range.low) / range.size(), 0.0, 1.0);
  };
  const auto box = [&](double from, double to, double thick, const cv::Scalar& colour) {
    canvas.Box({std::min(from, to), at.y - thick / 2, std::abs(to - from), thick}, 1, colour);
  };
  canvas.Text(view.name(signal), {at.x, at.y + kSmall / 2}, kSmall, palette::kInk);
  canvas.Box({at.x + kName, at.y - kThick / 2, kTrack, kThick}, kThick / 2, palette::kLine);
  box(x_of(view.rest(signal)), x_of(target), kThick, palette::kBone);
  const bool stands_out = std::abs(view.relative_error(row, signal)) >= kStandsOut;
  if (stands_out) box(x_of(target), x_of(predicted), 4, palette::kParameter);
  canvas.Box({x_of(predicted) - 1.25, at.y - 7, 2.5, 14}, 1, palette::kInk);
  canvas.Text(ValueText(target, range.size()), {at.x + kName + kTrack + 41, at.y + kSmall / 2},
              kSmall, palette::kInk, Align::kRight);
  canvas.Text(ValueText(predicted, range.size()), {at.x + kName + kTrack + 86, at.y + kSmall / 2},
              kSmall, stands_out ? kAlarm : palette::kMuted, Align::kRight, stands_out);
}

void DrawCard(const View& view, std::size_t row, double error, const FaceFrame& frame,
              cv::Point2d corner, Canvas& canvas) {
  canvas.Box({corner.x, corner.y, kCardWidth, kCardHeight}, 10, palette::kCard);
  const bool at_rest = row == view.neutral_row();
  canvas.Text("row " + std::to_string(row + 1) + (at_rest ? ", at rest" : ""),
              {corner.x + kInset, corner.y + 27}, 11, palette::kInk, Align::kLeft, true);
  canvas.Text("error " + Number("%.1f %%", 100 * error),
              {corner.x + kCardWidth - kInset, corner.y + 27}, kSmall,
              error >= kStandsOut ? kAlarm : palette::kMuted, Align::kRight, error >= kStandsOut);
  DrawFace(view, row, frame, {corner.x + kInset, corner.y + 38}, canvas);
  std::size_t left_out = 0;
  cv::Point2d at{corner.x + kInset + kFaceWidth + 14, corner.y + 38 + kBarPitch / 2};
  const std::vector<std::size_t> signals = Telling(view, row, left_out);
  for (const std::size_t signal : signals) {
    DrawBar(view, row, signal, at, canvas);
    at.y += kBarPitch;
  }
  if (signals.empty())
    canvas.Text("every target at rest", {at.x, at.y + kSmall / 2}, kSmall, palette::kMuted);
  if (left_out > 0)
    canvas.Text("and " + std::to_string(left_out) + " that move less", {at.x, at.y + kSmall / 2},
                kSmall, palette::kMuted);
}

std::vector<Figure> FiguresOf(const View& view, const std::vector<double>& errors) {
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
  return RowErrorsOf(View(training));
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
  const View view(training);
  const std::vector<double> errors = RowErrorsOf(view);
  const double lines = static_cast<double>((shown.size() + kCardColumns - 1) / kCardColumns);
  const double top = kHeadHeight + kRowPanelHeight + kGap + TargetPanelHeight(view) + kLegendHeight;
  Canvas canvas(kSheetWidthPx, static_cast<int>(top + lines * (kCardHeight + kGap) + kGap),
                palette::kPaper);
  DrawHead("a training set, and what the other rows predict for each row", FiguresOf(view, errors),
           canvas);
  canvas.Text(subtitle, {kSheetWidthPx - kMargin, 54}, 10, palette::kInk, Align::kRight);
  DrawRowErrors(errors, shown, kHeadHeight, canvas);
  DrawTargetErrors(view, kHeadHeight + kRowPanelHeight + kGap, canvas);
  DrawLegend(top - kLegendHeight, canvas);
  const FaceFrame frame(view, shown);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const cv::Point2d corner{kMargin + static_cast<double>(i % kCardColumns) * (kCardWidth + kGap),
                             top + static_cast<double>(i / kCardColumns) * (kCardHeight + kGap)};
    DrawCard(view, shown[i], errors[shown[i]], frame, corner, canvas);
  }
  return canvas.Finish();
}

}  // namespace facewire::tools
