#ifndef FACEWIRE_TOOLS_SHEET_CANVAS_H_
#define FACEWIRE_TOOLS_SHEET_CANVAS_H_

#include <opencv2/core.hpp>
#include <span>
#include <string>

namespace facewire::tools {

// Colours of every picture that facewire draws, as OpenCV wants them: blue, green, red.
namespace palette {
inline const cv::Scalar kPaper{239, 244, 246};
inline const cv::Scalar kCard{255, 255, 255};
inline const cv::Scalar kLine{214, 219, 222};
inline const cv::Scalar kInk{46, 39, 34};
inline const cv::Scalar kMuted{140, 130, 122};
inline const cv::Scalar kTrack{123, 200, 60};      // what the tracker sees
inline const cv::Scalar kBone{182, 111, 61};       // bones of the character
inline const cv::Scalar kParameter{59, 116, 232};  // parameters of the character
}  // namespace palette

enum class Align { kLeft, kCentre, kRight };

// A picture under construction, measured in pixels of the finished picture. It is drawn at twice
// the size and brought down at the end, which smooths OpenCV's stroke fonts as well as every edge.
class Canvas {
 public:
  Canvas(int width_px, int height_px, const cv::Scalar& background);

  void Fill(std::span<const cv::Point2d> outline, const cv::Scalar& colour);
  void Stroke(std::span<const cv::Point2d> line, const cv::Scalar& colour, double width_px,
              bool closed = false);
  void Disc(cv::Point2d centre, double radius_px, const cv::Scalar& colour);
  void Box(const cv::Rect2d& box, double corner_px, const cv::Scalar& colour);
  // `at` is the baseline's left end, middle or right end; `size_px` the height of a capital letter.
  void Text(const std::string& text, cv::Point2d at, double size_px, const cv::Scalar& colour,
            Align align = Align::kLeft, bool bold = false);
  // Scales the picture (8-bit BGR) into the box.
  void Picture(const cv::Mat& picture, const cv::Rect2d& box);

  // The width of a text in pixels, as Text would draw it.
  static double TextWidth(const std::string& text, double size_px, bool bold = false);

  cv::Mat Finish() const;

 private:
  cv::Mat image_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_CANVAS_H_
