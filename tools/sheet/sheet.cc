#include "tools/sheet/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/sheet/canvas.h"
#include "tools/sheet/character.h"
#include "tools/sheet/head.h"
#include "tools/sheet/overlay.h"

namespace facewire::tools {
namespace {

// All lengths in pixels of the finished sheet.
constexpr double kRowHeight = 356;
constexpr double kRowGap = 16;
constexpr double kPictureWidth = 405;
constexpr double kPictureHeight = 324;
constexpr double kInset = 16;
constexpr double kCharacterX = kInset + kPictureWidth + 12;
constexpr double kCharacterWidth = 300;
constexpr double kBarsX = kCharacterX + kCharacterWidth + 16;
constexpr double kBarsTop = 72;
constexpr double kBarPitch = 22;
constexpr std::size_t kBarRows = 12;
constexpr double kBarColumns[] = {kBarsX, kBarsX + 394};
constexpr double kLabelWidth = 156;
constexpr double kTrackWidth = 128;

std::string ValueText(const Channel& channel, float value) {
  if (IsPosition(channel.kind)) return Number("%+.2f cm", static_cast<double>(value));
  if (IsRotation(channel.kind)) return Number("%+.1f deg", static_cast<double>(value));
  return Number("%.2f", static_cast<double>(value));
}

// The channels of one kind (bones' or parameters) that move most in the moments, in the rig's
// order.
std::vector<std::size_t> Liveliest(const Rig& rig, std::span<const Moment> moments, bool bones) {
  std::vector<std::pair<double, std::size_t>> by_motion;
  for (std::size_t i = 0; i < rig.channels.size(); ++i) {
    const Channel& channel = rig.channels[i];
    if ((channel.kind != ChannelKind::kParameter) != bones) continue;
    double motion = 0;
    for (const Moment& moment : moments) {
      const double away = static_cast<double>(moment.pose.values[i] - channel.neutral);
      motion = std::max(
          motion, std::abs(away) / std::max(1e-6, static_cast<double>(channel.max - channel.min)));
    }
    by_motion.emplace_back(-motion, i);
  }
  std::ranges::stable_sort(by_motion);
  by_motion.resize(std::min(by_motion.size(), kBarRows));
  std::vector<std::size_t> channels;
  channels.reserve(by_motion.size());
  for (const auto& [motion, index] : by_motion) channels.push_back(index);
  std::ranges::sort(channels);
  return channels;
}

// A bar from the neutral value to the present one, on a track that spans the channel's range.
void DrawBar(const Channel& channel, float value, cv::Point2d at, const cv::Scalar& colour,
             Canvas& canvas) {
  const double span = std::max(1e-6, static_cast<double>(channel.max - channel.min));
  const double track = at.x + kLabelWidth;
  const auto x_of = [&](float v) {
    return track + kTrackWidth * std::clamp(static_cast<double>(v - channel.min) / span, 0.0, 1.0);
  };
  constexpr double kThick = 8;
  canvas.Text(std::string(channel.name.view()), {at.x, at.y + kSmall / 2}, kSmall, palette::kInk);
  canvas.Box({track, at.y - kThick / 2, kTrackWidth, kThick}, kThick / 2, palette::kLine);
  const double from = std::min(x_of(value), x_of(channel.neutral));
  const double to = std::max(x_of(value), x_of(channel.neutral));
  canvas.Box({from, at.y - kThick / 2, std::max(2.0, to - from), kThick}, 2, colour);
  canvas.Box({x_of(channel.neutral) - 1, at.y - kThick, 2, 2 * kThick}, 1, palette::kMuted);
  canvas.Text(ValueText(channel, value), {track + kTrackWidth + 80, at.y + kSmall / 2}, kSmall,
              palette::kInk, Align::kRight);
}

void DrawBars(const Rig& rig, const Moment& moment, std::span<const std::size_t> channels,
              const char* heading, cv::Point2d at, const cv::Scalar& colour, Canvas& canvas) {
  canvas.Text(heading, {at.x, at.y - 20}, kSmall, palette::kMuted);
  for (const std::size_t index : channels) {
    DrawBar(rig.channels[index], moment.pose.values[index], at, colour, canvas);
    at.y += kBarPitch;
  }
}

// The part of a picture that a window of kPictureWidth x kPictureHeight shows: the face with some
// air around it, or, without a face, the middle.
cv::Rect View(const cv::Mat& picture, const Landmarks& landmarks) {
  constexpr double kAir = 1.5;  // height of the view in heights of the face
  constexpr double kShape = kPictureWidth / kPictureHeight;
  double height = picture.rows;
  cv::Point2d centre(picture.cols / 2.0, picture.rows / 2.0);
  if (landmarks.count > 0) {
    const std::span points(landmarks.points_px.data(), landmarks.count);
    const auto [left, right] = std::ranges::minmax(points, {}, &Point3::x);
    const auto [top, bottom] = std::ranges::minmax(points, {}, &Point3::y);
    height = kAir * static_cast<double>(bottom.y - top.y);
    centre = {static_cast<double>(left.x + right.x) / 2, static_cast<double>(top.y + bottom.y) / 2};
  }
  height = std::clamp(height, 16.0, std::min<double>(picture.rows, picture.cols / kShape));
  const double width = height * kShape;
  return {cv::Point(cv::Point2d(std::clamp(centre.x - width / 2, 0.0, picture.cols - width),
                                std::clamp(centre.y - height / 2, 0.0, picture.rows - height))),
          cv::Size(cv::Size2d(std::floor(width), std::floor(height)))};
}

void DrawRow(const Rig& rig, const Moment& moment,
             const std::array<std::vector<std::size_t>, 2>& channels, const cv::Rect2d& row,
             Canvas& canvas) {
  canvas.Box(row, 10, palette::kCard);
  const cv::Rect2d window{row.x + kInset, row.y + kInset, kPictureWidth, kPictureHeight};
  canvas.Box(window, 6, palette::kInk);
  if (!moment.picture.empty()) {
    const cv::Rect view = View(moment.picture, moment.landmarks);
    canvas.Picture(moment.picture(view), window);
    const double zoom_x = window.width / view.width;
    const double zoom_y = window.height / view.height;
    DrawLandmarks(moment.landmarks, {window.x - view.x * zoom_x, window.y - view.y * zoom_y},
                  {zoom_x, zoom_y}, canvas);
  }
  DrawCharacter(CharacterPoseOf(rig, moment.pose),
                {row.x + kCharacterX, row.y + kInset, kCharacterWidth, kPictureHeight}, canvas);
  const double text_x = row.x + kBarsX;
  canvas.Text(moment.caption, {text_x, row.y + 34}, 14, palette::kInk, Align::kLeft, true);
  canvas.Text(Number("%.2f s", moment.time_s) + ", frame " + std::to_string(moment.frame),
              {row.x + row.width - kInset, row.y + 34}, 10, palette::kMuted, Align::kRight);
  const char* const headings[] = {"bones", "parameters"};
  const cv::Scalar* const colours[] = {&palette::kBone, &palette::kParameter};
  std::size_t column = 0;
  for (std::size_t kind = 0; kind < channels.size(); ++kind) {
    if (channels[kind].empty()) continue;
    DrawBars(rig, moment, channels[kind], headings[kind],
             {row.x + kBarColumns[column], row.y + kBarsTop + kBarPitch / 2}, *colours[kind],
             canvas);
    ++column;
  }
}

}  // namespace

cv::Mat DrawSheet(const std::string& title, std::span<const Figure> figures, const Rig& rig,
                  std::span<const Moment> moments) {
  const double rows = static_cast<double>(moments.size());
  Canvas canvas(kSheetWidthPx,
                static_cast<int>(kHeadHeight + rows * (kRowHeight + kRowGap) + kRowGap),
                palette::kPaper);
  DrawHead(title, figures, canvas);
  const std::array channels{Liveliest(rig, moments, true), Liveliest(rig, moments, false)};
  double y = kHeadHeight;
  for (const Moment& moment : moments) {
    DrawRow(rig, moment, channels, {kMargin, y, kSheetWidthPx - 2 * kMargin, kRowHeight}, canvas);
    y += kRowHeight + kRowGap;
  }
  return canvas.Finish();
}

}  // namespace facewire::tools
