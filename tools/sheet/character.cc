#include "tools/sheet/character.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace facewire::tools {
namespace {

const cv::Scalar kPlate{226, 218, 210};
const cv::Scalar kPlateShade{205, 194, 184};
const cv::Scalar kMetal{120, 106, 96};
const cv::Scalar kEdge{84, 72, 64};
const cv::Scalar kLid{190, 176, 164};
const cv::Scalar kEyeWhite{252, 252, 252};
const cv::Scalar kIris{150, 140, 30};
const cv::Scalar kMouth{52, 36, 60};
const cv::Scalar kLip{98, 102, 214};

// A point of the head: x to the character's left, y up, z out of the face; the head is about 2
// wide.
using Vec = cv::Vec3d;

double Radians(double deg) { return deg * std::numbers::pi / 180; }

// Turns points of the head as camera_R_head of core/face_pose.h does and brings them onto the
// picture.
class View {
 public:
  View(const CharacterPose& pose, const cv::Rect2d& box)
      : unit_px_(std::min(box.width / 2.6, box.height / 3.2)),
        origin_(box.x + box.width / 2, box.y + box.height * 0.475) {
    const double pitch = Radians(pose.pitch_deg);
    const double yaw = Radians(pose.yaw_deg);
    const double roll = Radians(pose.roll_deg);
    const cv::Matx33d ry(std::cos(yaw), 0, std::sin(yaw), 0, 1, 0, -std::sin(yaw), 0,
                         std::cos(yaw));
    const cv::Matx33d rx(1, 0, 0, 0, std::cos(pitch), -std::sin(pitch), 0, std::sin(pitch),
                         std::cos(pitch));
    const cv::Matx33d rz(std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll), 0, 0,
                         0, 1);
    rotation_ = ry * rx * rz;
    roll_ = rz;
  }

  double unit_px() const { return unit_px_; }

  // A point of the face's surface.
  cv::Point2d Face(const Vec& p) const { return Flat(rotation_ * p); }
  // A point of the head's outline, which looks the same from every side: it only rolls.
  cv::Point2d Outline(const Vec& p) const { return Flat(roll_ * p); }
  // A point of the stand, which does not move.
  cv::Point2d Stand(const Vec& p) const { return Flat(p); }

 private:
  cv::Point2d Flat(const Vec& p) const {
    return {origin_.x + unit_px_ * p[0], origin_.y - unit_px_ * p[1]};
  }

  double unit_px_;
  cv::Point2d origin_;
  cv::Matx33d rotation_;
  cv::Matx33d roll_;
};

std::vector<cv::Point2d> Bezier(cv::Point2d a, cv::Point2d b, cv::Point2d c, cv::Point2d d) {
  constexpr int kSteps = 24;
  std::vector<cv::Point2d> line;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    const double s = 1 - t;
    line.push_back(s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d);
  }
  return line;
}

// A rounded shape between ellipse (exponent 2) and box, from angle `from` to `to` (degrees,
// counter-clockwise).
template <class Project>
std::vector<cv::Point2d> Shell(const Vec& centre, double rx, double ry, double exponent,
                               double from, double to, const Project& project) {
  constexpr int kSteps = 64;
  std::vector<cv::Point2d> line;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = Radians(from + (to - from) * i / kSteps);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    line.push_back(
        project(centre + Vec{std::copysign(rx * std::pow(std::abs(c), 2 / exponent), c),
                             std::copysign(ry * std::pow(std::abs(s), 2 / exponent), s), 0}));
  }
  return line;
}

void DrawStand(const View& view, Canvas& canvas) {
  const auto stand = [&](const Vec& p) { return view.Stand(p); };
  const std::array neck{stand({-0.30, -0.8, 0}), stand({0.30, -0.8, 0}), stand({0.36, -1.5, 0}),
                        stand({-0.36, -1.5, 0})};
  canvas.Fill(neck, kMetal);
  for (const double y : {-1.22, -1.34, -1.46}) {
    const std::array ring{stand({-0.42, y, 0}), stand({0.42, y, 0})};
    canvas.Stroke(ring, kEdge, view.unit_px() * 0.05);
  }
  const auto base = Shell({0, -1.62, 0}, 0.85, 0.17, 5, 0, 180, stand);
  canvas.Fill(base, kEdge);
}

void DrawPlates(const CharacterPose& pose, const View& view, Canvas& canvas) {
  const auto outline = [&](const Vec& p) { return view.Outline(p); };
  const double edge = view.unit_px() * 0.035;
  // The aerial and the ears sit behind the shell.
  const std::array aerial{outline({0, 1.0, 0}), outline({0, 1.42, 0})};
  canvas.Stroke(aerial, kEdge, view.unit_px() * 0.05);
  canvas.Disc(aerial[1], view.unit_px() * 0.075, palette::kParameter);
  for (const double side : {-1.0, 1.0}) {
    const auto ear = Shell({side * 0.98, 0.1, 0}, 0.14, 0.24, 4, 0, 360, outline);
    canvas.Fill(ear, kMetal);
    canvas.Stroke(ear, kEdge, edge, true);
  }
  // The jaw slides out from under the shell.
  const auto jaw = Shell({0, -0.42 - 0.34 * pose.jaw, 0}, 0.72, 0.70, 3, 180, 360, outline);
  std::vector<cv::Point2d> chin = jaw;
  chin.push_back(outline({0.72, -0.1, 0}));
  chin.push_back(outline({-0.72, -0.1, 0}));
  canvas.Fill(chin, kPlateShade);
  canvas.Stroke(chin, kEdge, edge, true);
  const auto shell = Shell({0, 0.2, 0}, 0.96, 0.92, 2.7, 0, 360, outline);
  canvas.Fill(shell, kPlate);
  canvas.Stroke(shell, kEdge, edge, true);
}

void DrawMouth(const CharacterPose& pose, const View& view, Canvas& canvas) {
  constexpr double kZ = 0.8;
  const double drop = 0.40 * pose.jaw;
  const double middle = -0.44;
  const Vec left{0.36 + 0.13 * pose.corner_left_x, middle - 0.4 * drop + 0.16 * pose.corner_left_y,
                 kZ};
  const Vec right{-0.36 - 0.13 * pose.corner_right_x,
                  middle - 0.4 * drop + 0.16 * pose.corner_right_y, kZ};
  const double sag = -0.05 * (pose.corner_left_y + pose.corner_right_y);
  const double upper = middle + 0.05 + sag;
  const double lower = middle - 0.05 - drop * 1.25 + sag;
  const auto curve = [&](double y) {
    return Bezier(view.Face(right), view.Face({right[0] * 0.45, y, kZ}),
                  view.Face({left[0] * 0.45, y, kZ}), view.Face(left));
  };
  const auto upper_lip = curve(upper);
  auto lower_lip = curve(lower);
  std::vector<cv::Point2d> opening = upper_lip;
  opening.insert(opening.end(), lower_lip.rbegin(), lower_lip.rend());
  canvas.Fill(opening, kMouth);
  canvas.Stroke(lower_lip, kLip, view.unit_px() * 0.075);
  canvas.Stroke(upper_lip, kLip, view.unit_px() * 0.075);
}

// side: -1 the character's right eye, 1 the left one.
void DrawEye(const CharacterPose& pose, double side, const View& view, Canvas& canvas) {
  constexpr double kZ = 0.7;
  constexpr double kRadius = 0.25;
  // A neutral lid covers the eye's upper edge, as a relaxed one does.
  constexpr double kRestingLid = 0.14;
  const Vec centre{side * 0.42, 0.20, kZ};
  const double px = view.unit_px();
  const auto face = [&](const Vec& p) { return view.Face(p); };
  canvas.Fill(Shell(centre, kRadius, kRadius, 2, 0, 360, face), kEyeWhite);
  const cv::Point2d iris = view.Face(centre + Vec{0.10 * pose.gaze_x, 0.09 * pose.gaze_y, 0.05});
  canvas.Disc(iris, px * 0.135, kIris);
  canvas.Disc(iris, px * 0.065, palette::kInk);
  canvas.Disc(iris + cv::Point2d{px * 0.04, -px * 0.05}, px * 0.028, kEyeWhite);

  const double shut = std::clamp(side < 0 ? pose.lid_right : pose.lid_left, -kRestingLid, 1.0);
  // The lids meet in the lower half of the eye: the upper one does most of the way.
  const double meeting = 0.80;
  const auto angle_deg = [](double cover) {
    return std::asin(1 - 2 * cover) * 180 / std::numbers::pi;
  };
  const double upper_deg = angle_deg(kRestingLid + (meeting - kRestingLid) * shut);
  const auto upper = Shell(centre, kRadius, kRadius, 2, upper_deg, 180 - upper_deg, face);
  canvas.Fill(upper, kLid);
  if (shut > 0) {
    const double lower_deg = angle_deg(1 - (1 - meeting) * shut);
    canvas.Fill(Shell(centre, kRadius, kRadius, 2, lower_deg, -180 - lower_deg, face), kLid);
  }
  const std::array lash{upper.front(), upper.back()};
  canvas.Stroke(lash, kEdge, px * 0.05);
  canvas.Stroke(Shell(centre, kRadius, kRadius, 2, 0, 360, face), kEdge, px * 0.035, true);
}

void DrawBrow(const CharacterPose& pose, double side, const View& view, Canvas& canvas) {
  constexpr double kZ = 0.72;
  const double raise = side < 0 ? pose.brow_right : pose.brow_left;
  const double y = 0.60 + (raise > 0 ? 0.17 : 0.08) * raise;
  // Lowering pulls the inner end down, raising lifts the arch: what reads as cross and as
  // surprised.
  const double inner = y + 0.12 * std::min(raise, 0.0);
  const double arch = 0.09 + 0.06 * std::max(raise, 0.0);
  const auto brow =
      Bezier(view.Face({side * 0.17, inner, kZ}), view.Face({side * 0.32, inner + arch, kZ}),
             view.Face({side * 0.52, y + arch, kZ}), view.Face({side * 0.68, y - 0.03, kZ}));
  canvas.Stroke(brow, kEdge, view.unit_px() * 0.085);
}

}  // namespace

void DrawCharacter(const CharacterPose& pose, const cv::Rect2d& box, Canvas& canvas) {
  const View view(pose, box);
  DrawStand(view, canvas);
  DrawPlates(pose, view, canvas);
  DrawMouth(pose, view, canvas);
  for (const double side : {-1.0, 1.0}) {
    DrawEye(pose, side, view, canvas);
    DrawBrow(pose, side, view, canvas);
  }
}

}  // namespace facewire::tools
