#include "core/wire/encoder.h"

#include <bit>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "core/wire/crc32.h"

namespace facewire::wire {

using std::byte;

// Writes one frame: delimiter, then everything through the CRC and COBS straight into `out`, so
// that no second buffer is needed.
class Encoder::Writer {
 public:
  Writer(std::span<byte> out, MessageType type, std::uint16_t sequence) noexcept : out_(out) {
    Store(byte{0});
    Integer(kVersion);
    Integer(static_cast<std::uint8_t>(type));
    Integer(sequence);
  }

  // Little-endian.
  template <class T>
  void Integer(T value) noexcept {
    static_assert(std::is_integral_v<T>);
    const auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      const auto b = static_cast<byte>((bits >> (8 * i)) & 0xFFU);
      crc_.Add(b);
      Stuff(b);
    }
  }
  void Float(float value) noexcept {
    valid_ = valid_ && std::isfinite(value);
    Integer(std::bit_cast<std::uint32_t>(value));
  }
  void Name(const ShortName& name) noexcept {
    const std::string_view text = name.view();
    Integer(static_cast<std::uint8_t>(text.size()));
    for (char c : text) Integer(static_cast<std::uint8_t>(c));
  }
  void Require(bool condition) noexcept { valid_ = valid_ && condition; }

  Result<std::span<const byte>> Finish() noexcept {
    const std::uint32_t crc = crc_.value();
    Integer(crc);
    CloseBlock();
    Store(byte{0});
    if (!valid_) return Errc::kInvalidArgument;
    if (full_) return Errc::kFull;
    return std::span<const byte>(out_.first(size_));
  }

 private:
  void Store(byte b) noexcept {
    if (size_ == out_.size()) {
      full_ = true;
    } else {
      out_[size_++] = b;
    }
  }
  void OpenBlock() noexcept {
    code_at_ = size_;
    block_ = 1;
    open_ = true;
    Store(byte{0});  // its code comes when the block's length is known
  }
  void CloseBlock() noexcept {
    if (open_ && !full_) out_[code_at_] = static_cast<byte>(block_);
    open_ = false;
  }
  // A block that 254 bytes have filled stands for no zero, so none is opened after it until there
  // is a byte to put into it: the shortest encoding.
  void Stuff(byte b) noexcept {
    if (!open_) OpenBlock();
    if (b == byte{0}) {
      CloseBlock();
      OpenBlock();
      return;
    }
    Store(b);
    if (++block_ == 0xFF) CloseBlock();
  }

  std::span<byte> out_;
  std::size_t size_ = 0;
  std::size_t code_at_ = 0;
  unsigned block_ = 1;
  bool open_ = false;
  bool full_ = false;
  bool valid_ = true;
  Crc32 crc_;
};

Result<std::span<const byte>> Encoder::Finish(Writer& writer) noexcept {
  const auto frame = writer.Finish();
  if (frame) sequence_ = sequence_ == 0xFFFF ? 1 : static_cast<std::uint16_t>(sequence_ + 1);
  return frame;
}

Result<std::span<const byte>> Encoder::Encode(const RigHeader& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kRigHeader, sequence_);
  w.Integer(m.rig_id);
  w.Integer(m.bones);
  w.Integer(m.channels);
  w.Name(m.name);
  w.Require(m.bones <= kMaxBones && m.channels <= kMaxChannels);
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const BoneDescription& m,
                                              std::span<byte> out) noexcept {
  Writer w(out, MessageType::kBone, sequence_);
  w.Integer(m.rig_id);
  w.Integer(m.index);
  w.Float(m.rest_cm.x);
  w.Float(m.rest_cm.y);
  w.Float(m.rest_cm.z);
  w.Name(m.name);
  w.Require(m.index < kMaxBones);
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const ChannelDescription& m,
                                              std::span<byte> out) noexcept {
  Writer w(out, MessageType::kChannel, sequence_);
  w.Integer(m.rig_id);
  w.Integer(m.index);
  w.Integer(static_cast<std::uint8_t>(m.kind));
  w.Integer(m.bone < 0 ? std::uint8_t{0xFF} : static_cast<std::uint8_t>(m.bone));
  w.Float(m.neutral);
  w.Float(m.min);
  w.Float(m.max);
  w.Name(m.name);
  w.Require(m.index < kMaxChannels && m.bone < static_cast<int>(kMaxBones));
  w.Require(m.min <= m.neutral && m.neutral <= m.max);
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const Pose& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kPose, sequence_);
  w.Integer(m.rig_id);
  w.Integer(m.frame_seq);
  w.Integer(m.captured.time_since_epoch().count());
  w.Integer(m.age_us);
  w.Integer(static_cast<std::uint8_t>(m.state));
  w.Integer(static_cast<std::uint8_t>(m.values.size()));
  for (std::uint16_t step : m.values) w.Integer(step);
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const Status& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kStatus, sequence_);
  w.Integer(m.rig_id);
  w.Integer(static_cast<std::uint8_t>(m.state));
  w.Integer(m.now.time_since_epoch().count());
  w.Integer(m.uptime_s);
  w.Integer(m.centi_fps);
  w.Integer(m.frames);
  w.Integer(m.dropped);
  w.Integer(m.losses);
  w.Integer(m.link_errors);
  w.Integer(m.latency_p50_us);
  w.Integer(m.latency_p99_us);
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const Acknowledgement& m,
                                              std::span<byte> out) noexcept {
  Writer w(out, MessageType::kAcknowledgement, sequence_);
  w.Integer(m.id);
  w.Integer(static_cast<std::uint8_t>(m.code));
  w.Integer(static_cast<std::uint8_t>(m.result));
  w.Integer(m.now.time_since_epoch().count());
  if (HasMeasure(m.result)) w.Float(m.measure);
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const Command& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kCommand, sequence_);
  w.Integer(m.id);
  w.Integer(static_cast<std::uint8_t>(m.code));
  if (TakesValue(m.code)) w.Float(m.value);
  if (TakesItem(m.code)) w.Integer(m.item);
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const Text& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kText, sequence_);
  w.Integer(m.id);
  w.Integer(static_cast<std::uint16_t>(m.text.size()));
  for (const char c : m.text) w.Integer(static_cast<std::uint8_t>(c));
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const ServoSetup& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kServoSetup, sequence_);
  w.Integer(m.setup_id);
  w.Integer(m.hold_ms);
  w.Integer(m.ease_ms);
  w.Integer(m.release_ms);
  w.Integer(static_cast<std::uint8_t>(m.servos.size()));
  w.Require(m.setup_id != 0);
  for (const ServoLimits& servo : m.servos) {
    w.Integer(servo.min_quarter_us);
    w.Integer(servo.neutral_quarter_us);
    w.Integer(servo.max_quarter_us);
    w.Integer(servo.speed_us_s);
    w.Integer(servo.ramp_speed_us_s);
    w.Integer(servo.ramp_acceleration_10us_s2);
    w.Require(IsValid(servo));
  }
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const ServoPulses& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kServoPulses, sequence_);
  w.Integer(m.setup_id);
  w.Integer(static_cast<std::uint8_t>(m.stop ? 1 : 0));
  w.Integer(static_cast<std::uint8_t>(m.quarter_us.size()));
  for (const std::uint16_t width : m.quarter_us) {
    w.Integer(width);
    w.Require(IsPulseOrNone(width));
  }
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const LandmarkPart& m, std::span<byte> out) noexcept {
  Writer w(out, MessageType::kLandmarks, sequence_);
  w.Integer(m.frame_seq);
  w.Integer(m.captured.time_since_epoch().count());
  w.Integer(m.width_px);
  w.Integer(m.height_px);
  w.Integer(m.total);
  w.Integer(m.first);
  w.Integer(static_cast<std::uint8_t>(m.points.size()));
  w.Require(IsValid(m));
  for (const LandmarkPoint& point : m.points) {
    w.Integer(point.x_eighth_px);
    w.Integer(point.y_eighth_px);
  }
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const ReceiverStatus& m,
                                              std::span<byte> out) noexcept {
  Writer w(out, MessageType::kReceiverStatus, sequence_);
  w.Integer(m.setup_id);
  w.Integer(static_cast<std::uint8_t>(m.state));
  w.Integer(m.capacity);
  w.Integer(m.version_major);
  w.Integer(m.version_minor);
  w.Integer(m.reset_causes);
  w.Integer(m.supply_mv);
  w.Integer(m.uptime_ms);
  w.Integer(m.frames);
  w.Integer(m.damaged);
  w.Integer(m.lost);
  w.Integer(m.refused);
  w.Integer(static_cast<std::uint8_t>(m.quarter_us.size()));
  w.Require(m.capacity <= kMaxServos);
  for (const std::uint16_t width : m.quarter_us) {
    w.Integer(width);
    w.Require(IsPulseOrNone(width));
  }
  return Finish(w);
}

Result<std::span<const byte>> Encoder::Encode(const Message& message,
                                              std::span<byte> out) noexcept {
  return std::visit([&](const auto& m) noexcept { return Encode(m, out); }, message);
}

}  // namespace facewire::wire
