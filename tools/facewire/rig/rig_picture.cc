#include "tools/facewire/rig/rig_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/retarget/alignment.h"
#include "tools/facewire/rig/bone_names.h"
#include "tools/facewire/rig/canonical_mesh.h"
#include "tools/facewire/rig/rig_check.h"
#include "tools/sheet/canvas.h"
#include "tools/sheet/head.h"

namespace facewire::tools::rig {
namespace {

constexpr double kViewHeight = 620;
constexpr double kFrontWidth = 880;
constexpr double kGap = 16;
constexpr double kRow = 24;
constexpr double kTitle = 44;
constexpr std::size_t kColumns = 2;
constexpr double kColumnWidth = (kSheetWidthPx - 2 * kMargin - kGap) / kColumns;

const cv::Scalar kFaint{226, 214, 200};
const cv::Scalar kReach{214, 176, 140};

std::string Text(const ShortName& name) { return std::string(name.view()); }

// The canonical face in the character's space; where the bones cannot say (none or one follows a
// landmark), the face as it is.
class FaceInRig {
 public:
  explicit FaceInRig(const Rig& rig) {
    std::vector<Point3> canonical, here;
    std::vector<std::int16_t> landmarks;
    for (const facewire::Bone& bone : rig.bones) {
      if (bone.landmark < 0 || static_cast<std::size_t>(bone.landmark) >= kMeshLandmarks) continue;
      canonical.push_back(kCanonicalMesh[static_cast<std::size_t>(bone.landmark)]);
      here.push_back(bone.rest_cm);
      landmarks.push_back(bone.landmark);
    }
    if (canonical.size() < 2) AlignEyes(rig, canonical, here, landmarks);
    if (const auto aligned = retarget::Align(canonical, here, landmarks); aligned) at_ = *aligned;
  }

  Point3 At(std::size_t landmark) const { return at_(kCanonicalMesh[landmark]); }
  double cm() const {
    return static_cast<double>(at_.scale.y);
  }  // of this face for one of a person's

 private:
  static void AlignEyes(const Rig& rig, std::vector<Point3>& canonical, std::vector<Point3>& here,
                        std::vector<std::int16_t>& landmarks) {
    for (const facewire::Bone& bone : rig.bones) {
      const auto role = MatchBone(bone.name.view());
      if (!role || role->kind != BoneKind::kEye) continue;
      const bool left = role->side == Side::kLeft;
      canonical.push_back(left ? kCanonicalLeftEye : kCanonicalRightEye);
      here.push_back(bone.rest_cm);
      landmarks.push_back(left ? kLeftIris : kRightIris);
    }
  }

  retarget::Alignment at_;
};

// One picture of the face, from a side.
class View {
 public:
  View(const Rig& rig, const FaceInRig& face, const cv::Rect2d& box, bool from_front)
      : rig_(rig), face_(face), box_(box), front_(from_front) {
    std::vector<cv::Point2d> all;
    for (std::size_t i = 0; i < kMeshLandmarks; ++i) all.push_back(Flat(face.At(i)));
    const auto [left, right] = std::ranges::minmax(all, {}, &cv::Point2d::x);
    const auto [bottom, top] = std::ranges::minmax(all, {}, &cv::Point2d::y);
    // Bones near the face are in the picture, the rest of a body is not.
    const double reach = 0.6 * (top.y - bottom.y);
    cv::Rect2d frame{left.x, bottom.y, right.x - left.x, top.y - bottom.y};
    for (const facewire::Bone& bone : rig.bones) {
      const cv::Point2d p = Flat(bone.rest_cm);
      if (!Near(p, frame, reach)) continue;
      all.push_back(p);
    }
    const auto [l, r] = std::ranges::minmax(all, {}, &cv::Point2d::x);
    const auto [b, t] = std::ranges::minmax(all, {}, &cv::Point2d::y);
    middle_ = {(l.x + r.x) / 2, (b.y + t.y) / 2};
    frame_ = {l.x, b.y, r.x - l.x, t.y - b.y};
    zoom_ = std::min((box.width - 2 * kRoomForNames) / std::max(1e-3, r.x - l.x),
                     (box.height - 110) / std::max(1e-3, t.y - b.y));
  }

  void Draw(const char* title, Canvas& canvas) const {
    canvas.Box(box_, 10, palette::kCard);
    canvas.Text(title, {box_.x + 18, box_.y + 30}, 11, palette::kMuted);
    for (std::size_t i = 0; i < kMeshLandmarks; ++i)
      canvas.Disc(At(face_.At(i)), 1.6, palette::kTrack);
    for (const auto& outline : Outlines()) {
      std::vector<cv::Point2d> line;
      line.reserve(outline.size());
      for (const int index : outline) line.push_back(At(face_.At(static_cast<std::size_t>(index))));
      canvas.Stroke(line, kFaint, 1.6, true);
    }
    std::vector<std::size_t> shown;
    std::vector<std::string> beyond;
    for (std::size_t i = 0; i < rig_.bones.size(); ++i) {
      if (!front_ && IsBehind(rig_.bones[i])) continue;
      if (Near(Flat(rig_.bones[i].rest_cm), frame_, 1e-3)) {
        shown.push_back(i);
      } else {
        beyond.push_back(Text(rig_.bones[i].name));
      }
    }
    DrawBones(shown, canvas);
    if (!beyond.empty())
      canvas.Text(
          "outside the picture: " + beyond[0] +
              (beyond.size() > 1 ? " and " + std::to_string(beyond.size() - 1) + " more" : ""),
          {box_.x + 18, box_.y + box_.height - 18}, kSmall, palette::kMuted);
  }

 private:
  static constexpr double kRoomForNames = 175;

  // The character's left is on the picture's right from the front; from its left it looks there.
  cv::Point2d Flat(Point3 p) const {
    return {static_cast<double>(front_ ? p.x : p.z), static_cast<double>(p.y)};
  }
  cv::Point2d At(Point3 p) const {
    const cv::Point2d flat = Flat(p) - middle_;
    const double sign = front_ ? 1 : -1;
    return {box_.x + box_.width / 2 + sign * zoom_ * flat.x,
            box_.y + box_.height / 2 + 8 - zoom_ * flat.y};
  }
  static bool Near(cv::Point2d p, const cv::Rect2d& frame, double reach) {
    return p.x >= frame.x - reach && p.x <= frame.x + frame.width + reach &&
           p.y >= frame.y - reach && p.y <= frame.y + frame.height + reach;
  }

  // From the left, the right half is behind the left one, whose bones mostly have the same places.
  bool IsBehind(const facewire::Bone& bone) const {
    constexpr std::size_t kNoseTip = 1;
    return static_cast<double>(face_.At(kNoseTip).x - bone.rest_cm.x) > 0.2 * face_.cm();
  }

  static const std::vector<std::vector<int>>& Outlines() {
    static const std::vector<std::vector<int>> kOutlines = {
        {10,  338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377,
         152, 148, 176, 149, 150, 136, 172, 58,  132, 93,  234, 127, 162, 21,  54,  103, 67,  109},
        {61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 409, 270, 269, 267, 0, 37, 39, 40, 185},
        {33, 7, 163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246},
        {263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466},
        {46, 53, 52, 65, 55, 107, 66, 105, 63, 70},
        {276, 283, 282, 295, 285, 336, 296, 334, 293, 300}};
    return kOutlines;
  }

  // Names stand in two columns beside the face, each as high as its bone or as near as there is
  // room, and a thin line leads to it.
  void DrawBones(const std::vector<std::size_t>& shown, Canvas& canvas) const {
    std::array<std::vector<std::size_t>, 2> sides;
    for (const std::size_t i : shown) {
      const double x = At(rig_.bones[i].rest_cm).x - (box_.x + box_.width / 2);
      // What is in the middle goes where there is more room.
      const bool right = std::abs(x) < 3 ? sides[1].size() < sides[0].size() : x > 0;
      sides[right ? 1 : 0].push_back(i);
    }
    for (std::size_t side = 0; side < 2; ++side) DrawNames(sides[side], side == 1, canvas);
    for (const std::size_t i : shown) {
      const facewire::Bone& bone = rig_.bones[i];
      const cv::Point2d at = At(bone.rest_cm);
      if (bone.landmark >= 0 && static_cast<std::size_t>(bone.landmark) < kMeshLandmarks) {
        const cv::Point2d landmark = At(face_.At(static_cast<std::size_t>(bone.landmark)));
        canvas.Stroke(std::array{at, landmark}, palette::kTrack, 2.5);
        canvas.Disc(landmark, 4.5, palette::kTrack);
      }
      canvas.Disc(at, 6.5, palette::kCard);
      canvas.Disc(at, 5, palette::kBone);
    }
  }

  void DrawNames(std::vector<std::size_t> bones, bool right, Canvas& canvas) const {
    std::ranges::stable_sort(bones, {}, [&](std::size_t i) { return At(rig_.bones[i].rest_cm).y; });
    const double top = box_.y + 60;
    const double bottom = box_.y + box_.height - 44;
    const double pitch =
        std::min(22.0, (bottom - top) / std::max<double>(1, static_cast<double>(bones.size())));
    double y = top;
    for (std::size_t row = 0; row < bones.size(); ++row) {
      const facewire::Bone& bone = rig_.bones[bones[row]];
      const cv::Point2d at = At(bone.rest_cm);
      const double rest = static_cast<double>(bones.size() - row - 1);
      y = std::clamp(at.y, y, bottom - rest * pitch);
      const double edge = right ? box_.x + box_.width - 18 : box_.x + 18;
      const std::string name = Text(bone.name);
      const double inner = right ? edge - Canvas::TextWidth(name, kSmall) - 6
                                 : edge + Canvas::TextWidth(name, kSmall) + 6;
      canvas.Stroke(std::array{cv::Point2d{inner, y}, at}, palette::kLine, 1);
      canvas.Text(name, {edge, y + kSmall / 2}, kSmall, palette::kInk,
                  right ? Align::kRight : Align::kLeft);
      y += pitch;
    }
  }

  const Rig& rig_;
  const FaceInRig& face_;
  cv::Rect2d box_;
  bool front_;
  cv::Point2d middle_;
  cv::Rect2d frame_;
  double zoom_ = 1;
};

struct Group {
  std::string title;
  std::vector<std::size_t> channels;
};

// Bones by their own order, parameters by the part of the face that drives them.
std::vector<Group> GroupsOf(const Rig& rig) {
  static constexpr std::array<std::pair<const char*, const char*>, 5> kParts = {{
      {"eye", "parameters: eyes"},
      {"brow", "parameters: brows"},
      {"jaw", "parameters: jaw"},
      {"mouth", "parameters: mouth"},
      {"", "parameters: the rest"},
  }};
  std::vector<Group> groups = {{"bones", {}}};
  for (const auto& part : kParts) groups.push_back({part.second, {}});
  for (std::size_t i = 0; i < rig.channels.size(); ++i) {
    const Channel& channel = rig.channels[i];
    if (channel.kind != ChannelKind::kParameter) {
      groups[0].channels.push_back(i);
      continue;
    }
    const std::string_view signal =
        channel.drives.empty() ? channel.name.view() : channel.drives[0].signal.view();
    std::size_t part = 0;
    while (!signal.starts_with(kParts[part].first)) ++part;
    groups[part + 1].channels.push_back(i);
  }
  std::erase_if(groups, [](const Group& group) { return group.channels.empty(); });
  return groups;
}

std::string Short(double value) {
  std::string text = Number("%.2f", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string DriversOf(const Channel& channel, const Rig& rig) {
  std::string text;
  for (const Drive& drive : channel.drives) {
    const auto gain = static_cast<double>(drive.gain);
    text += text.empty() ? "" : gain < 0 ? " - " : " + ";
    if (text.empty() && gain < 0) text += "-";
    if (std::abs(gain) != 1) text += Short(std::abs(gain)) + " ";
    text += Text(drive.signal);
  }
  if (!text.empty()) return text;
  if (!IsPosition(channel.kind)) return "nothing";
  const facewire::Bone& bone = rig.bones[static_cast<std::size_t>(channel.bone)];
  if (!bone.marker.empty()) return "marker " + Text(bone.marker);
  return bone.landmark < 0 ? "nothing" : "landmark " + std::to_string(bone.landmark);
}

std::string Cut(std::string text, double width, double size) {
  if (Canvas::TextWidth(text, size) <= width) return text;
  while (!text.empty() && Canvas::TextWidth(text + "...", size) > width) text.pop_back();
  return text + "...";
}

// A channel: its name, its range with what full signals reach of it and where neutral is, and what
// drives it.
void DrawChannel(const Rig& rig, const Channel& channel, cv::Point2d at, Canvas& canvas) {
  constexpr double kName = 196;
  constexpr double kEnd = 40;
  constexpr double kTrackWidth = 120;
  const bool bone = channel.kind != ChannelKind::kParameter;
  const double track = at.x + kName + kEnd;
  const double low = static_cast<double>(channel.min);
  const double span = std::max(1e-9, static_cast<double>(channel.max) - low);
  const auto x_of = [&](double v) {
    return track + kTrackWidth * std::clamp((v - low) / span, 0.0, 1.0);
  };
  const double base = at.y + kSmall / 2;
  canvas.Text(Cut(Text(channel.name), kName - 8, kSmall), {at.x, base}, kSmall, palette::kInk);
  canvas.Text(Short(low), {track - 8, base}, kSmall, palette::kMuted, Align::kRight);
  canvas.Box({track, at.y - 4, kTrackWidth, 8}, 4, palette::kLine);
  Reach reach = ReachOf(channel);
  if (channel.drives.empty() && IsPosition(channel.kind))
    reach = {low, static_cast<double>(channel.max)};
  const double from = x_of(reach.low);
  canvas.Box({from, at.y - 4, std::max(2.0, x_of(reach.high) - from), 8}, 3,
             bone ? palette::kBone : palette::kParameter);
  const double rest = x_of(static_cast<double>(channel.neutral));
  canvas.Box({rest - 1.25, at.y - 8, 2.5, 16}, 1, palette::kInk);
  canvas.Text(Short(static_cast<double>(channel.max)) + (IsPosition(channel.kind)   ? " cm"
                                                         : IsRotation(channel.kind) ? " deg"
                                                                                    : ""),
              {track + kTrackWidth + 8, base}, kSmall, palette::kMuted);
  const double drivers = track + kTrackWidth + 70;
  canvas.Text(Cut(DriversOf(channel, rig), at.x + kColumnWidth - 18 - drivers - 18, kSmall),
              {drivers, base}, kSmall, palette::kMuted);
}

// A row of the table.
struct Cell {
  const Group* group = nullptr;
  std::size_t row = 0;  // of the group; its title is before row 0
};

}  // namespace

cv::Mat DrawRig(const Rig& rig) {
  const std::vector<Group> groups = GroupsOf(rig);
  std::vector<Cell> cells;
  double height = 0;
  for (const Group& group : groups) {
    height += kTitle + kRow * static_cast<double>(group.channels.size());
    for (std::size_t row = 0; row < group.channels.size(); ++row) cells.push_back({&group, row});
  }
  // A group that goes on in the next column has its title there again.
  const double column_height = height / kColumns + kTitle + kRow;
  const double panel = column_height + 24;
  const double table = kHeadHeight + kViewHeight + 2 * kGap;
  Canvas canvas(kSheetWidthPx, static_cast<int>(table + panel + kMargin), palette::kPaper);
  const auto count = [&](auto of_kind) {
    return std::to_string(std::ranges::count_if(rig.channels, of_kind));
  };
  const auto is_bone = [](const Channel& c) { return c.kind != ChannelKind::kParameter; };
  const std::array figures{
      Figure{std::to_string(rig.bones.size()), "bones"},
      Figure{std::to_string(std::ranges::count_if(
                 rig.bones, [](const facewire::Bone& b) { return b.landmark >= 0; })),
             "of them follow a landmark"},
      Figure{count(is_bone), "axes of bones"},
      Figure{count([&](const Channel& c) { return !is_bone(c); }), "parameters"},
      Figure{count([](const Channel& c) { return c.max_speed_per_s == 0; }),
             "without a limit of speed"}};
  DrawHead("the rig " + Text(rig.name), figures, canvas);
  const FaceInRig face(rig);
  View(rig, face, {kMargin, kHeadHeight + kGap, kFrontWidth, kViewHeight}, true)
      .Draw("from the front: its left is on the right", canvas);
  View(rig, face,
       {kMargin + kFrontWidth + kGap, kHeadHeight + kGap,
        kSheetWidthPx - 2 * kMargin - kFrontWidth - kGap, kViewHeight},
       false)
      .Draw("from its left, without the bones behind", canvas);
  std::size_t next = 0;
  for (std::size_t column = 0; column < kColumns; ++column) {
    const double x = kMargin + static_cast<double>(column) * (kColumnWidth + kGap);
    canvas.Box({x, table, kColumnWidth, panel}, 10, palette::kCard);
    double y = table + 8;
    const Group* group = nullptr;
    while (next < cells.size() &&
           y - table + (cells[next].group == group ? 0 : kTitle) <= panel - kRow) {
      const Cell& cell = cells[next++];
      if (cell.group != group) {
        group = cell.group;
        canvas.Text(group->title, {x + 18, y + 28}, 11, palette::kInk, Align::kLeft, true);
        y += kTitle;
      }
      DrawChannel(rig, rig.channels[group->channels[cell.row]], {x + 18, y + kRow / 2 - 4}, canvas);
      y += kRow;
    }
  }
  return canvas.Finish();
}

}  // namespace facewire::tools::rig
