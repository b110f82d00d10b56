#include "core/wire/livelink/livelink.h"

#include <bit>
#include <numbers>

namespace facewire::wire::livelink {
namespace {

// Everything is big-endian. The caller has made sure of the room.
class Packet {
 public:
  explicit Packet(std::span<std::byte> out) noexcept : out_(out) {}
  void Put(std::uint8_t value) noexcept { out_[size_++] = static_cast<std::byte>(value); }
  void Put(std::int32_t value) noexcept {
    const auto word = static_cast<std::uint32_t>(value);
    for (int shift = 24; shift >= 0; shift -= 8) {
      out_[size_++] = static_cast<std::byte>(word >> shift);
    }
  }
  void Put(float value) noexcept { Put(std::bit_cast<std::int32_t>(value)); }
  void Put(std::string_view text) noexcept {
    Put(static_cast<std::int32_t>(text.size()));
    for (char c : text) out_[size_++] = static_cast<std::byte>(c);
  }
  // Degrees of the rig as radians of Unreal's rotators; README.md has the signs.
  void Put(const HeadAngles& angles) noexcept {
    constexpr float kRadians = std::numbers::pi_v<float> / 180;
    Put(-angles.yaw_deg * kRadians);
    Put(angles.pitch_deg * kRadians);
    Put(-angles.roll_deg * kRadians);
  }
  std::span<const std::byte> bytes() const noexcept { return out_.first(size_); }

 private:
  std::span<std::byte> out_;
  std::size_t size_ = 0;
};

bool Fits(std::string_view text) noexcept { return !text.empty() && text.size() <= kMaxTextBytes; }

}  // namespace

Result<std::span<const std::byte>> Encode(const Subject& subject, Time captured,
                                          const arkit::Face* face,
                                          std::span<std::byte> out) noexcept {
  if (!Fits(subject.device_id) || !Fits(subject.name)) return Errc::kOutOfRange;
  const std::size_t values = face != nullptr ? 1 + 4 * std::size_t{kValues} : 0;
  if (out.size() < 1 + 4 + subject.device_id.size() + 4 + subject.name.size() + 16 + values) {
    return Errc::kFull;
  }
  constexpr std::int64_t kDayUs = 86'400'000'000;
  constexpr std::int64_t kSecondUs = 1'000'000;
  const std::int64_t of_day =
      ((captured.time_since_epoch().count() % kDayUs) + kDayUs) % kDayUs * kTimecodeHz;

  Packet packet(out);
  packet.Put(kVersion);
  packet.Put(subject.device_id);
  packet.Put(subject.name);
  packet.Put(static_cast<std::int32_t>(of_day / kSecondUs));
  packet.Put(static_cast<float>(of_day % kSecondUs) / static_cast<float>(kSecondUs));
  packet.Put(kTimecodeHz);
  packet.Put(std::int32_t{1});
  if (face != nullptr) {
    packet.Put(kValues);
    for (float shape : face->shapes) packet.Put(shape);
    packet.Put(HeadOf(*face));
    packet.Put(face->left_eye);
    packet.Put(face->right_eye);
  }
  return packet.bytes();
}

}  // namespace facewire::wire::livelink
