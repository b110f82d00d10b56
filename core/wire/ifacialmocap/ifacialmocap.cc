#include "core/wire/ifacialmocap/ifacialmocap.h"

#include <array>
#include <cmath>
#include <cstdlib>

namespace facewire::wire::ifacialmocap {
namespace {

constexpr long kSteps = 10'000;  // of a degree

class Line {
 public:
  explicit Line(std::span<std::byte> out) noexcept : out_(out) {}

  void Put(char c) noexcept {
    if (size_ < out_.size()) {
      out_[size_++] = static_cast<std::byte>(c);
    } else {
      full_ = true;
    }
  }
  void Put(std::string_view text) noexcept {
    for (char c : text) Put(c);
  }
  // `digits` at least.
  void PutNumber(long value, int digits = 1) noexcept {
    std::array<char, 20> reversed{};
    int size = 0;
    for (; value > 0 || size < digits; value /= 10) {
      reversed[size++] = static_cast<char>('0' + value % 10);
    }
    while (size > 0) Put(reversed[--size]);
  }
  // Not a number, and what is no angle, is 0: a receiver would stumble over the word.
  void PutDegrees(float degrees) noexcept {
    const long steps = std::fabs(degrees) <= 360 ? std::lround(degrees * float{kSteps}) : 0;
    if (steps < 0) Put('-');
    PutNumber(std::labs(steps) / kSteps);
    Put('.');
    PutNumber(std::labs(steps) % kSteps, 4);
  }
  void PutAngles(const HeadAngles& angles) noexcept {
    PutDegrees(angles.pitch_deg);
    Put(',');
    PutDegrees(angles.yaw_deg);
    Put(',');
    PutDegrees(angles.roll_deg);
  }
  // "mouthSmileLeft" is "mouthSmile_L" here; "jawLeft" and "mouthLeft" are directions and stay.
  void PutShape(std::string_view name) noexcept {
    const bool direction = name.starts_with("jaw") || name == "mouthLeft" || name == "mouthRight";
    if (!direction && name.ends_with("Left")) {
      Put(name.substr(0, name.size() - 4));
      Put("_L");
    } else if (!direction && name.ends_with("Right")) {
      Put(name.substr(0, name.size() - 5));
      Put("_R");
    } else {
      Put(name);
    }
  }

  Result<std::span<const std::byte>> Finish() const noexcept {
    if (full_) return Errc::kFull;
    return std::span<const std::byte>(out_.first(size_));
  }

 private:
  std::span<std::byte> out_;
  std::size_t size_ = 0;
  bool full_ = false;
};

}  // namespace

Result<std::span<const std::byte>> Encode(Version version, const arkit::Face& face, bool tracking,
                                          std::span<std::byte> out) noexcept {
  const char separator = version == Version::kFirst ? '-' : '&';
  Line line(out);
  for (std::size_t i = 0; i < arkit::kShapes; ++i) {
    line.PutShape(arkit::kShapeNames[i]);
    line.Put(separator);
    const float shape = face.shapes[i];
    line.PutNumber(shape > 0 ? std::lround(std::fmin(shape, 1.0F) * 100) : 0);
    line.Put('|');
  }
  line.Put("trackingStatus");
  line.Put(separator);
  line.Put(tracking ? '1' : '0');
  line.Put("|=head#");
  line.PutAngles(HeadOf(face));
  line.Put(",0,0,0|rightEye#");  // where the head is does not cross the wire
  line.PutAngles(face.right_eye);
  line.Put("|leftEye#");
  line.PutAngles(face.left_eye);
  line.Put('|');
  return line.Finish();
}

}  // namespace facewire::wire::ifacialmocap
