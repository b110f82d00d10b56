#include "tools/sheet/canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace facewire::tools {
namespace {

constexpr int kScale = 2;  // drawn pixels for a finished one
constexpr int kShift = 4;  // fractional bits of OpenCV's drawing coordinates
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontCapital = 21;  // height of a capital of that font at scale 1, in pixels

std::vector<cv::Point> Fixed(std::span<const cv::Point2d> points) {
  std::vector<cv::Point> fixed;
  fixed.reserve(points.size());
  for (const cv::Point2d& p : points) {
    fixed.emplace_back(static_cast<int>(std::lround(p.x * kScale * (1 << kShift))),
                       static_cast<int>(std::lround(p.y * kScale * (1 << kShift))));
  }
  return fixed;
}

int Thickness(double width_px) {
  return std::max(1, static_cast<int>(std::lround(width_px * kScale)));
}

int FontThickness(double size_px, bool bold) {
  return Thickness(std::max(0.75, size_px * (bold ? 0.17 : 0.11)));
}

}  // namespace

Canvas::Canvas(int width_px, int height_px, const cv::Scalar& background)
    : image_(height_px * kScale, width_px * kScale, CV_8UC3, background) {}

void Canvas::Fill(std::span<const cv::Point2d> outline, const cv::Scalar& colour) {
  cv::fillPoly(image_, std::vector<std::vector<cv::Point>>{Fixed(outline)}, colour, cv::LINE_AA,
               kShift);
}

void Canvas::Stroke(std::span<const cv::Point2d> line, const cv::Scalar& colour, double width_px,
                    bool closed) {
  cv::polylines(image_, std::vector<std::vector<cv::Point>>{Fixed(line)}, closed, colour,
                Thickness(width_px), cv::LINE_AA, kShift);
}

void Canvas::Disc(cv::Point2d centre, double radius_px, const cv::Scalar& colour) {
  const int radius = static_cast<int>(std::lround(radius_px * kScale * (1 << kShift)));
  cv::circle(image_, Fixed({&centre, 1}).front(), radius, colour, cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::Box(const cv::Rect2d& box, double corner_px, const cv::Scalar& colour) {
  const double r = std::min({corner_px, box.width / 2, box.height / 2});
  constexpr int kSteps = 8;
  std::vector<cv::Point2d> outline;
  for (int corner = 0; corner < 4; ++corner) {
    const cv::Point2d centre{corner == 0 || corner == 3 ? box.x + box.width - r : box.x + r,
                             corner < 2 ? box.y + box.height - r : box.y + r};
    for (int step = 0; step <= kSteps; ++step) {
      const double angle = (corner + static_cast<double>(step) / kSteps) * std::numbers::pi / 2;
      outline.emplace_back(centre.x + r * std::cos(angle), centre.y + r * std::sin(angle));
    }
  }
  Fill(outline, colour);
}

double Canvas::TextWidth(const std::string& text, double size_px, bool bold) {
  int baseline = 0;
  const double scale = size_px * kScale / kFontCapital;
  return cv::getTextSize(text, kFont, scale, FontThickness(size_px, bold), &baseline).width /
         static_cast<double>(kScale);
}

void Canvas::Text(const std::string& text, cv::Point2d at, double size_px, const cv::Scalar& colour,
                  Align align, bool bold) {
  if (align != Align::kLeft) {
    at.x -= TextWidth(text, size_px, bold) * (align == Align::kCentre ? 0.5 : 1.0);
  }
  cv::putText(image_, text, cv::Point(cv::Point2d{at.x * kScale, at.y * kScale}), kFont,
              size_px * kScale / kFontCapital, colour, FontThickness(size_px, bold), cv::LINE_AA);
}

void Canvas::Picture(const cv::Mat& picture, const cv::Rect2d& box) {
  const cv::Rect target(cv::Point(cv::Point2d{box.x * kScale, box.y * kScale}),
                        cv::Size(cv::Size2d{box.width * kScale, box.height * kScale}));
  cv::resize(picture, image_(target), target.size(), 0, 0, cv::INTER_CUBIC);
}

cv::Mat Canvas::Finish() const {
  cv::Mat finished;
  cv::resize(image_, finished, {image_.cols / kScale, image_.rows / kScale}, 0, 0, cv::INTER_AREA);
  return finished;
}

}  // namespace facewire::tools
