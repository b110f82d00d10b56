#include "core/wire/arkit/arkit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/inline_vector.h"

namespace facewire::wire::arkit {
namespace {

constexpr float kDegrees = std::numbers::pi_v<float> / 180;

// In lower case, without what separates words, _L and _R in full. Room for the longest name of a
// rig and its side.
class PlainName {
 public:
  explicit PlainName(std::string_view name) noexcept {
    const bool has_side = name.size() > 2 && IsSeparator(name[name.size() - 2]);
    const char side = has_side ? Lower(name.back()) : '\0';
    const bool short_side = side == 'l' || side == 'r';
    if (short_side) name.remove_suffix(2);
    for (char c : name.substr(0, kMaxNameLength)) {
      if (!IsSeparator(c)) (void)text_.try_push(Lower(c));
    }
    if (short_side) {
      for (char c : std::string_view(side == 'l' ? "left" : "right")) (void)text_.try_push(c);
    }
  }
  std::string_view view() const noexcept { return {text_.begin(), text_.size()}; }
  friend bool operator==(const PlainName& a, const PlainName& b) noexcept {
    return a.view() == b.view();
  }

 private:
  static constexpr bool IsSeparator(char c) noexcept { return c == '_' || c == '.' || c == '-'; }
  static constexpr char Lower(char c) noexcept {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  InlineVector<char, kMaxNameLength + 5> text_;
};

// R = Ry(yaw) Rx(pitch) Rz(roll), by rows.
Matrix3 MatrixOf(const HeadAngles& a) noexcept {
  const float cp = std::cos(a.pitch_deg * kDegrees), sp = std::sin(a.pitch_deg * kDegrees);
  const float cy = std::cos(a.yaw_deg * kDegrees), sy = std::sin(a.yaw_deg * kDegrees);
  const float cr = std::cos(a.roll_deg * kDegrees), sr = std::sin(a.roll_deg * kDegrees);
  return {cy * cr + sy * sp * sr, sy * sp * cr - cy * sr, sy * cp, cp * sr, cp * cr, -sp,
          cy * sp * sr - sy * cr, sy * sr + cy * sp * cr, cy * cp};
}

bool IsRest(const HeadAngles& a) noexcept {
  return a.pitch_deg == 0 && a.yaw_deg == 0 && a.roll_deg == 0;
}

}  // namespace

std::optional<std::size_t> FindShape(std::string_view name) noexcept {
  const PlainName wanted(name);
  for (std::size_t i = 0; i < kShapes; ++i) {
    if (PlainName(kShapeNames[i]) == wanted) return i;
  }
  return std::nullopt;
}

HeadAngles HeadOf(const Face& face) noexcept {
  // Exactly what the one bone has where there is only one.
  if (IsRest(face.head)) return face.neck;
  if (IsRest(face.neck)) return face.head;
  const Matrix3 neck = MatrixOf(face.neck);
  const Matrix3 head = MatrixOf(face.head);
  const Point3 y = neck * Point3{head[1], head[4], head[7]};  // where the head's axes point
  const Point3 z = neck * Point3{head[2], head[5], head[8]};
  const Point3 x = neck * Point3{head[0], head[3], head[6]};
  return {.pitch_deg = std::asin(std::clamp(-z.y, -1.0F, 1.0F)) / kDegrees,
          .yaw_deg = std::atan2(z.x, z.z) / kDegrees,
          .roll_deg = std::atan2(x.y, y.y) / kDegrees};
}

FaceMap::FaceMap(const Rig& rig) noexcept {
  for (std::size_t i = 0; i < rig.channels.size(); ++i) {
    const Channel& c = rig.channels[i];
    const auto channel = static_cast<int>(i);
    if (c.kind == ChannelKind::kParameter) {
      const auto shape = FindShape(c.name.view());
      if (!shape || HasShape(*shape)) continue;
      const bool scaled = c.max > 1 && c.max > c.neutral;
      shapes_[*shape] = {.channel = channel,
                         .zero = scaled ? c.neutral : 0.0F,
                         .scale = scaled ? 1 / (c.max - c.neutral) : 1.0F};
    } else if (IsRotation(c.kind) && c.bone >= 0 &&
               static_cast<std::size_t>(c.bone) < rig.bones.size()) {
      Rotation* rotation = RotationOf(rig.bones[static_cast<std::size_t>(c.bone)].name.view());
      if (rotation == nullptr) continue;
      if (c.kind == ChannelKind::kPitch) rotation->pitch.channel = channel;
      if (c.kind == ChannelKind::kYaw) rotation->yaw.channel = channel;
      if (c.kind == ChannelKind::kRoll) rotation->roll.channel = channel;
    }
  }
}

FaceMap::Rotation* FaceMap::RotationOf(std::string_view bone) noexcept {
  const PlainName name(bone);
  if (name.view() == "neck") return &neck_;
  if (name.view() == "head") return &head_;
  if (name.view() == "eyeleft" || name.view() == "lefteye") return &left_eye_;
  if (name.view() == "eyeright" || name.view() == "righteye") return &right_eye_;
  return nullptr;
}

float FaceMap::Source::Of(const RigPose& pose) const noexcept {
  if (channel < 0 || static_cast<std::size_t>(channel) >= pose.count) return 0;
  return (pose.values[static_cast<std::size_t>(channel)] - zero) * scale;
}

HeadAngles FaceMap::Rotation::Of(const RigPose& pose) const noexcept {
  return {.pitch_deg = pitch.Of(pose), .yaw_deg = yaw.Of(pose), .roll_deg = roll.Of(pose)};
}

Face FaceMap::FaceOf(const RigPose& pose) const noexcept {
  Face face;
  for (std::size_t i = 0; i < kShapes; ++i) {
    face.shapes[i] = std::clamp(shapes_[i].Of(pose), 0.0F, 1.0F);
  }
  face.neck = neck_.Of(pose);
  face.head = head_.Of(pose);
  face.left_eye = left_eye_.Of(pose);
  face.right_eye = right_eye_.Of(pose);
  return face;
}

}  // namespace facewire::wire::arkit
