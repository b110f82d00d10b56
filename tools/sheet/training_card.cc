#include "tools/sheet/training_card.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tools/sheet/head.h"

namespace facewire::tools {
namespace {

const cv::Scalar kAlarm{16, 72, 190};  // kParameter, dark enough for small letters

// All lengths in pixels of the finished sheet.
constexpr double kInset = 16;
constexpr double kFaceWidth = 172;
constexpr double kFaceHeight = 176;
constexpr double kBarPitch = 20;
constexpr std::size_t kBars = 8;
constexpr double kThick = 8;

// A target counts in a row when it, or what is predicted, is so far from rest; an error stands out
// from so much on. In parts of the target's range.
constexpr double kMatters = 0.05;
constexpr double kStandsOut = 0.1;

void DrawFace(const TrainingView& view, std::size_t row, const FaceFrame& frame, cv::Point2d corner,
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
std::vector<std::size_t> Telling(const TrainingView& view, std::size_t row, std::size_t& left_out) {
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
  signals.reserve(by_motion.size());
  for (const auto& [motion, signal] : by_motion) signals.push_back(signal);
  std::ranges::sort(signals);
  return signals;
}

void DrawBar(const TrainingView& view, std::size_t row, std::size_t signal, cv::Point2d at,
             Canvas& canvas) {
  constexpr double kName = 132;
  constexpr double kTrack = 74;
  const double target = view.target(row, signal);
  const double predicted = view.prediction(row, signal);
  const TargetRange& range = view.range(signal);
  // A prediction may leave the range of the targets: it is seen to do so, within the card.
  constexpr double kBeyond = 0.1;
  const auto x_of = [&](double value) {
    return at.x + kName +
           kTrack * std::clamp((value - range.low) / range.size(), -kBeyond, 1 + kBeyond);
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

}  // namespace

FaceFrame::FaceFrame(const TrainingView& view, std::span<const std::size_t> shown) {
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

cv::Point2d FaceFrame::At(cv::Point2d cm, cv::Point2d corner) const {
  return {corner.x + kFaceWidth / 2 + px_per_cm_ * (cm.x - centre_.x),
          corner.y + kFaceHeight / 2 - px_per_cm_ * (cm.y - centre_.y)};
}

void DrawTrainingCard(const TrainingView& view, std::size_t row, const FaceFrame& frame,
                      cv::Point2d corner, Canvas& canvas) {
  const double error = view.row_error(row);
  canvas.Box({corner.x, corner.y, kTrainingCardWidth, kTrainingCardHeight}, 10, palette::kCard);
  const bool at_rest = row == view.neutral_row();
  canvas.Text("row " + std::to_string(row + 1) + (at_rest ? ", at rest" : ""),
              {corner.x + kInset, corner.y + 27}, 11, palette::kInk, Align::kLeft, true);
  canvas.Text("error " + Number("%.1f %%", 100 * error),
              {corner.x + kTrainingCardWidth - kInset, corner.y + 27}, kSmall,
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

void DrawTrainingLegend(double middle, Canvas& canvas) {
  double x = kMargin;
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

}  // namespace facewire::tools
