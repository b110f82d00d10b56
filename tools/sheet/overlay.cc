#include "tools/sheet/overlay.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace facewire::tools {
namespace {

// Outlines by number of MediaPipe's face mesh, each walked around once.
constexpr std::array kFaceOutline{10,  338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288,
                                  397, 365, 379, 378, 400, 377, 152, 148, 176, 149, 150, 136,
                                  172, 58,  132, 93,  234, 127, 162, 21,  54,  103, 67,  109};
constexpr std::array kOuterLips{61,  146, 91,  181, 84,  17, 314, 405, 321, 375,
                                291, 409, 270, 269, 267, 0,  37,  39,  40,  185};
constexpr std::array kInnerLips{78,  95,  88,  178, 87,  14, 317, 402, 318, 324,
                                308, 415, 310, 311, 312, 13, 82,  81,  80,  191};
constexpr std::array kRightEye{33,  7,   163, 144, 145, 153, 154, 155,
                               133, 173, 157, 158, 159, 160, 161, 246};
constexpr std::array kLeftEye{263, 249, 390, 373, 374, 380, 381, 382,
                              362, 398, 384, 385, 386, 387, 388, 466};
constexpr std::array kRightBrow{46, 53, 52, 65, 55, 107, 66, 105, 63, 70};
constexpr std::array kLeftBrow{276, 283, 282, 295, 285, 336, 296, 334, 293, 300};
// The centre of an iris, and the first of the four points around it.
constexpr std::array<std::size_t, 2> kIrisCentres{468, 473};

const cv::Scalar kContour{236, 255, 214};

}  // namespace

void DrawLandmarks(const Landmarks& landmarks, cv::Point2d origin, cv::Size2d zoom,
                   Canvas& canvas) {
  if (landmarks.count < kMeshLandmarks) return;
  const auto at = [&](std::size_t i) {
    const Point3& p = landmarks.points_px[i];
    return cv::Point2d{origin.x + zoom.width * static_cast<double>(p.x),
                       origin.y + zoom.height * static_cast<double>(p.y)};
  };
  for (std::size_t i = 0; i < kMeshLandmarks; ++i) canvas.Disc(at(i), 0.9, palette::kTrack);
  const auto outline = [&](const auto& indices, double width_px) {
    std::vector<cv::Point2d> line;
    line.reserve(std::size(indices));
    for (const int index : indices) line.push_back(at(static_cast<std::size_t>(index)));
    canvas.Stroke(line, kContour, width_px, true);
  };
  outline(kFaceOutline, 1.0);
  outline(kOuterLips, 1.0);
  outline(kInnerLips, 1.0);
  outline(kRightEye, 1.0);
  outline(kLeftEye, 1.0);
  outline(kRightBrow, 1.0);
  outline(kLeftBrow, 1.0);
  if (landmarks.count < kMaxLandmarks) return;
  for (const std::size_t centre : kIrisCentres) canvas.Disc(at(centre), 2.2, palette::kParameter);
}

}  // namespace facewire::tools
