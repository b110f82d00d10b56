#include "tools/sheet/traces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/sheet/canvas.h"

namespace facewire::tools {
namespace {

// All lengths in pixels of the finished picture.
constexpr double kLegendHeight = 44;
constexpr double kLaneHeight = 226;
constexpr double kLaneGap = 14;
constexpr double kInset = 18;
constexpr double kEdge = 28;  // where half of a time's name may stand
constexpr double kWordsWidth = 276;
constexpr double kScaleWidth = 52;  // for the numbers at a plot's left
constexpr double kWholeWidth = 690;
constexpr double kPlotTop = 34;
constexpr double kPlotBottom = 34;  // from the lane's lower edge
constexpr double kLine = 19;

const cv::Scalar kPosition = palette::kInk;

// 1, 2 or 5 times a power of ten, so that `span` has about `wanted` of them.
double Step(double span, double wanted) {
  const double rough = span / wanted;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

// Of a line of the grid, `step` from the next.
std::string Label(double value, double step) {
  const double rounded = std::round(value / step) * step + 0.0;  // no -0
  return Number(step < 1 ? "%.1f" : "%.0f", rounded);
}

// A rectangle of the picture with its two axes.
struct Plot {
  cv::Rect2d box;
  TimeSpan time;
  double low, high;

  double X(double t_s) const {
    return box.x + box.width * (t_s - time.from_s) / (time.to_s - time.from_s);
  }
  double Y(double value) const {
    return box.y + box.height * (1 - (std::clamp(value, low, high) - low) / (high - low));
  }
};

void DrawAxes(const Plot& plot, bool names_seconds, Canvas& canvas) {
  canvas.Box(plot.box, 0, palette::kPaper);
  const double rise = Step(plot.high - plot.low, 4);
  for (double v = std::ceil(plot.low / rise) * rise; v <= plot.high; v += rise) {
    const std::array line{cv::Point2d{plot.box.x, plot.Y(v)},
                          cv::Point2d{plot.box.x + plot.box.width, plot.Y(v)}};
    canvas.Stroke(line, palette::kLine, 1);
    canvas.Text(Label(v, rise), {plot.box.x - 8, plot.Y(v) + kSmall / 2}, kSmall, palette::kMuted,
                Align::kRight);
  }
  const double step = Step(plot.time.to_s - plot.time.from_s, plot.box.width / 90);
  const double bottom = plot.box.y + plot.box.height;
  for (double t = std::ceil(plot.time.from_s / step - 1e-9) * step; t <= plot.time.to_s + 1e-9;
       t += step) {
    const std::array line{cv::Point2d{plot.X(t), plot.box.y}, cv::Point2d{plot.X(t), bottom}};
    canvas.Stroke(line, palette::kLine, 1);
    canvas.Text(Label(t, step) + (names_seconds ? " s" : ""), {plot.X(t), bottom + 18}, kSmall,
                palette::kMuted, Align::kCentre);
  }
}

// What the curve is at `t_s`, between two of its points.
double Between(const TimedValue& before, const TimedValue& after, double t_s, bool holds) {
  if (holds || std::isnan(before.value) || std::isnan(after.value)) return before.value;
  return before.value +
         (after.value - before.value) * (t_s - before.t_s) / (after.t_s - before.t_s);
}

// The part of the curve within the time, its ends where the time's are.
Curve Within(const Curve& curve, TimeSpan time, bool holds) {
  Curve part;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const bool last = i + 1 == curve.size();
    if (curve[i].t_s > time.to_s) break;
    if (curve[i].t_s < time.from_s) {
      if (!last && curve[i + 1].t_s > time.from_s) {
        part.push_back({time.from_s, Between(curve[i], curve[i + 1], time.from_s, holds)});
      }
    } else {
      part.push_back(curve[i]);
    }
    if (!last && !part.empty() && curve[i + 1].t_s > time.to_s) {
      part.push_back({time.to_s, Between(curve[i], curve[i + 1], time.to_s, holds)});
    }
  }
  return part;
}

void DrawCurve(const Plot& plot, const Curve& curve, bool holds, const cv::Scalar& colour,
               double width_px, Canvas& canvas) {
  std::vector<cv::Point2d> line;
  const auto draw = [&] {
    if (line.size() > 1) canvas.Stroke(line, colour, width_px);
    line.clear();
  };
  for (const auto& [t_s, value] : Within(curve, plot.time, holds)) {
    const double x = plot.X(t_s);
    if (holds && !line.empty()) line.emplace_back(x, line.back().y);
    if (std::isnan(value)) {
      draw();
    } else {
      line.emplace_back(x, plot.Y(value));
    }
  }
  draw();
}

// What the curves reach in the plot's time, with some air, and a thirtieth of the range at least,
// so that a servo at rest does not look as if it shook.
void FitHeight(const TraceLane& lane, Plot& plot) {
  double low = INFINITY;
  double high = -INFINITY;
  for (const Curve* curve : {&lane.parameter, &lane.command, &lane.position}) {
    for (const auto& [t_s, value] : Within(*curve, plot.time, curve == &lane.command)) {
      low = std::fmin(low, value);  // whichever is a number
      high = std::fmax(high, value);
    }
  }
  if (low > high) low = lane.low, high = lane.high;
  const double middle = (low + high) / 2;
  const double half = std::max({(high - low) * 0.56, (lane.high - lane.low) / 60, 1e-6});
  plot.low = middle - half;
  plot.high = middle + half;
}

void DrawPlot(const TraceLane& lane, const cv::Rect2d& box, TimeSpan time, bool names_seconds,
              Canvas& canvas) {
  Plot plot{box, time, 0, 1};
  FitHeight(lane, plot);
  DrawAxes(plot, names_seconds, canvas);
  // The limits, where they are in sight.
  for (const double limit : {lane.low, lane.high}) {
    if (limit < plot.low || limit > plot.high) continue;
    const std::array line{cv::Point2d{box.x, plot.Y(limit)},
                          cv::Point2d{box.x + box.width, plot.Y(limit)}};
    canvas.Stroke(line, palette::kMuted, 1.5);
  }
  DrawCurve(plot, lane.parameter, false, palette::kParameter, 2.5, canvas);
  DrawCurve(plot, lane.command, true, palette::kBone, 1.5, canvas);
  DrawCurve(plot, lane.position, false, kPosition, 1.5, canvas);
}

void DrawLane(const TraceLane& lane, const cv::Rect2d& row, TimeSpan whole, Canvas& canvas) {
  canvas.Box(row, 10, palette::kCard);
  double y = row.y + 36;
  canvas.Text(lane.title, {row.x + kInset, y}, 14, palette::kInk, Align::kLeft, true);
  y += 8;
  for (const std::string& words : lane.subtitle) {
    canvas.Text(words, {row.x + kInset, y += kLine}, kSmall, palette::kMuted);
  }
  y += 8;
  for (const std::string& words : lane.remarks) {
    canvas.Text(words, {row.x + kInset, y += kLine}, kSmall, palette::kInk);
  }
  const double top = row.y + kPlotTop;
  const double height = row.height - kPlotTop - kPlotBottom;
  const double whole_x = row.x + kWordsWidth + kScaleWidth;
  const double close_x = whole_x + kWholeWidth + kInset + kScaleWidth;
  canvas.Text(lane.unit, {whole_x - 8, row.y + 24}, kSmall, palette::kMuted, Align::kRight);
  canvas.Text("close up", {close_x, row.y + 24}, kSmall, palette::kMuted);
  DrawPlot(lane, {whole_x, top, kWholeWidth, height}, whole, false, canvas);
  DrawPlot(lane, {close_x, top, row.x + row.width - kEdge - close_x, height}, lane.close_up, true,
           canvas);
}

void DrawLegend(double y, Canvas& canvas) {
  struct Entry {
    const cv::Scalar& colour;
    double width_px;
    const char* words;
  };
  const std::array<Entry, 4> entries{
      {{palette::kParameter, 2.5,
        "parameter in: the pose on the host's line, through the rig's map"},
       {palette::kBone, 1.5, "command: what the bus was asked for"},
       {kPosition, 1.5, "position: where the servo is"},
       {palette::kMuted, 1.5, "limits of the servo"}}};
  double x = kMargin;
  for (const Entry& entry : entries) {
    const std::array line{cv::Point2d{x, y - kSmall / 2}, cv::Point2d{x + 34, y - kSmall / 2}};
    canvas.Stroke(line, entry.colour, entry.width_px + 0.5);
    canvas.Text(entry.words, {x + 44, y}, kSmall, palette::kInk);
    x += 44 + Canvas::TextWidth(entry.words, kSmall) + 32;
  }
  canvas.Text("time in seconds", {kSheetWidthPx - kMargin, y}, kSmall, palette::kMuted,
              Align::kRight);
}

}  // namespace

cv::Mat DrawTraces(const std::string& title, std::span<const Figure> figures,
                   std::span<const TraceLane> lanes, TimeSpan whole) {
  const double rows = static_cast<double>(lanes.size());
  Canvas canvas(
      kSheetWidthPx,
      static_cast<int>(kHeadHeight + kLegendHeight + rows * (kLaneHeight + kLaneGap) + kLaneGap),
      palette::kPaper);
  DrawHead(title, figures, canvas);
  DrawLegend(kHeadHeight + 18, canvas);
  double y = kHeadHeight + kLegendHeight;
  for (const TraceLane& lane : lanes) {
    DrawLane(lane, {kMargin, y, kSheetWidthPx - 2 * kMargin, kLaneHeight}, whole, canvas);
    y += kLaneHeight + kLaneGap;
  }
  return canvas.Finish();
}

}  // namespace facewire::tools
