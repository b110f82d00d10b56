#include "core/wire/decoder.h"

#include <bit>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "core/wire/crc32.h"

namespace facewire::wire {
namespace {

using std::byte;

// Reads a payload from the front; past its end everything is zero and ok() is false. What is left
// at the end belongs to a later protocol and is ignored.
class Reader {
 public:
  explicit Reader(std::span<const byte> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  T Integer() noexcept {
    static_assert(std::is_integral_v<T>);
    if (bytes_.size() < sizeof(T)) {
      ok_ = false;
      return 0;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bits |= std::to_integer<std::uint64_t>(bytes_[i]) << (8 * i);
    }
    bytes_ = bytes_.subspan(sizeof(T));
    return static_cast<T>(bits);
  }
  float Float() noexcept {
    const auto value = std::bit_cast<float>(Integer<std::uint32_t>());
    Require(std::isfinite(value));
    return value;
  }
  Time Instant() noexcept { return Time(Duration(Integer<std::int64_t>())); }
  ServiceState State() noexcept {
    const auto state = static_cast<ServiceState>(Integer<std::uint8_t>());
    return state <= ServiceState::kFault ? state : ServiceState::kFault;
  }
  ShortName Name() noexcept {
    const auto size = Integer<std::uint8_t>();
    if (size == 0) return {};
    if (bytes_.size() < size) {
      ok_ = false;
      return {};
    }
    const auto name =
        ShortName::From(std::string_view(reinterpret_cast<const char*>(bytes_.data()), size));
    bytes_ = bytes_.subspan(size);
    Require(name.has_value());
    return name.value_or(ShortName{});
  }
  void Require(bool condition) noexcept { ok_ = ok_ && condition; }
  bool ok() const noexcept { return ok_; }

 private:
  std::span<const byte> bytes_;
  bool ok_ = true;
};

RigHeader ReadRigHeader(Reader& r) noexcept {
  RigHeader m;
  m.rig_id = r.Integer<std::uint32_t>();
  m.bones = r.Integer<std::uint8_t>();
  m.channels = r.Integer<std::uint8_t>();
  m.name = r.Name();
  r.Require(m.bones <= kMaxBones && m.channels <= kMaxChannels);
  return m;
}

BoneDescription ReadBone(Reader& r) noexcept {
  BoneDescription m;
  m.rig_id = r.Integer<std::uint32_t>();
  m.index = r.Integer<std::uint8_t>();
  m.rest_cm.x = r.Float();
  m.rest_cm.y = r.Float();
  m.rest_cm.z = r.Float();
  m.name = r.Name();
  r.Require(m.index < kMaxBones);
  return m;
}

ChannelDescription ReadChannel(Reader& r) noexcept {
  ChannelDescription m;
  m.rig_id = r.Integer<std::uint32_t>();
  m.index = r.Integer<std::uint8_t>();
  const auto kind = static_cast<ChannelKind>(r.Integer<std::uint8_t>());
  m.kind = kind <= ChannelKind::kRoll ? kind : ChannelKind::kParameter;
  const auto bone = r.Integer<std::uint8_t>();
  m.bone = bone == 0xFF ? std::int16_t{-1} : std::int16_t{bone};
  m.neutral = r.Float();
  m.min = r.Float();
  m.max = r.Float();
  m.name = r.Name();
  r.Require(m.index < kMaxChannels && m.bone < static_cast<int>(kMaxBones));
  r.Require(m.min <= m.neutral && m.neutral <= m.max);
  return m;
}

Pose ReadPose(Reader& r) noexcept {
  Pose m;
  m.rig_id = r.Integer<std::uint32_t>();
  m.frame_seq = r.Integer<std::uint32_t>();
  m.captured = r.Instant();
  m.age_us = r.Integer<std::uint32_t>();
  m.state = r.State();
  const auto count = r.Integer<std::uint8_t>();
  r.Require(m.values.try_resize(count));
  for (std::uint16_t& step : m.values) step = r.Integer<std::uint16_t>();
  return m;
}

Status ReadStatus(Reader& r) noexcept {
  Status m;
  m.rig_id = r.Integer<std::uint32_t>();
  m.state = r.State();
  m.now = r.Instant();
  m.uptime_s = r.Integer<std::uint32_t>();
  m.centi_fps = r.Integer<std::uint16_t>();
  m.frames = r.Integer<std::uint32_t>();
  m.dropped = r.Integer<std::uint32_t>();
  m.losses = r.Integer<std::uint32_t>();
  m.link_errors = r.Integer<std::uint32_t>();
  m.latency_p50_us = r.Integer<std::uint32_t>();
  m.latency_p99_us = r.Integer<std::uint32_t>();
  return m;
}

Acknowledgement ReadAcknowledgement(Reader& r) noexcept {
  Acknowledgement m;
  m.id = r.Integer<std::uint16_t>();
  m.code = static_cast<CommandCode>(r.Integer<std::uint8_t>());
  m.result = static_cast<CommandResult>(r.Integer<std::uint8_t>());
  m.now = r.Instant();
  if (HasMeasure(m.result)) m.measure = r.Float();
  return m;
}

Command ReadCommand(Reader& r) noexcept {
  Command m;
  m.id = r.Integer<std::uint16_t>();
  m.code = static_cast<CommandCode>(r.Integer<std::uint8_t>());
  if (TakesValue(m.code)) m.value = r.Float();
  if (TakesItem(m.code)) m.item = r.Integer<std::uint8_t>();
  return m;
}

Text ReadText(Reader& r) noexcept {
  Text m;
  m.id = r.Integer<std::uint16_t>();
  r.Require(m.text.try_resize(r.Integer<std::uint16_t>()));
  for (char& c : m.text) c = static_cast<char>(r.Integer<std::uint8_t>());
  return m;
}

ServoSetup ReadServoSetup(Reader& r) noexcept {
  ServoSetup m;
  m.setup_id = r.Integer<std::uint32_t>();
  m.hold_ms = r.Integer<std::uint32_t>();
  m.ease_ms = r.Integer<std::uint32_t>();
  m.release_ms = r.Integer<std::uint32_t>();
  r.Require(m.setup_id != 0 && m.servos.try_resize(r.Integer<std::uint8_t>()));
  for (ServoLimits& servo : m.servos) {
    servo.min_quarter_us = r.Integer<std::uint16_t>();
    servo.neutral_quarter_us = r.Integer<std::uint16_t>();
    servo.max_quarter_us = r.Integer<std::uint16_t>();
    servo.speed_us_s = r.Integer<std::uint16_t>();
    servo.ramp_speed_us_s = r.Integer<std::uint16_t>();
    servo.ramp_acceleration_10us_s2 = r.Integer<std::uint16_t>();
    r.Require(IsValid(servo));
  }
  return m;
}

void ReadPulses(Reader& r, InlineVector<std::uint16_t, kMaxServos>& quarter_us) noexcept {
  r.Require(quarter_us.try_resize(r.Integer<std::uint8_t>()));
  for (std::uint16_t& width : quarter_us) {
    width = r.Integer<std::uint16_t>();
    r.Require(IsPulseOrNone(width));
  }
}

ServoPulses ReadServoPulses(Reader& r) noexcept {
  ServoPulses m;
  m.setup_id = r.Integer<std::uint32_t>();
  m.stop = (r.Integer<std::uint8_t>() & 1U) != 0;
  ReadPulses(r, m.quarter_us);
  return m;
}

LandmarkPart ReadLandmarkPart(Reader& r) noexcept {
  LandmarkPart m;
  m.frame_seq = r.Integer<std::uint32_t>();
  m.captured = r.Instant();
  m.width_px = r.Integer<std::uint16_t>();
  m.height_px = r.Integer<std::uint16_t>();
  m.total = r.Integer<std::uint16_t>();
  m.first = r.Integer<std::uint16_t>();
  r.Require(m.points.try_resize(r.Integer<std::uint8_t>()) && IsValid(m));
  for (LandmarkPoint& point : m.points) {
    point.x_eighth_px = r.Integer<std::int16_t>();
    point.y_eighth_px = r.Integer<std::int16_t>();
  }
  return m;
}

ReceiverStatus ReadReceiverStatus(Reader& r) noexcept {
  ReceiverStatus m;
  m.setup_id = r.Integer<std::uint32_t>();
  const auto state = static_cast<ReceiverState>(r.Integer<std::uint8_t>());
  m.state = state <= ReceiverState::kStopped ? state : ReceiverState::kWaiting;
  m.capacity = r.Integer<std::uint8_t>();
  m.version_major = r.Integer<std::uint8_t>();
  m.version_minor = r.Integer<std::uint8_t>();
  m.reset_causes = r.Integer<std::uint8_t>();
  m.supply_mv = r.Integer<std::uint16_t>();
  m.uptime_ms = r.Integer<std::uint32_t>();
  m.frames = r.Integer<std::uint32_t>();
  m.damaged = r.Integer<std::uint32_t>();
  m.lost = r.Integer<std::uint32_t>();
  m.refused = r.Integer<std::uint32_t>();
  r.Require(m.capacity <= kMaxServos);
  ReadPulses(r, m.quarter_us);
  return m;
}

Result<Message> ReadPayload(std::uint8_t type, std::span<const byte> payload) noexcept {
  Reader r(payload);
  const auto checked = [&r](const auto& message) -> Result<Message> {
    if (!r.ok()) return Errc::kInvalidArgument;
    return Message(message);
  };
  switch (static_cast<MessageType>(type)) {
    case MessageType::kRigHeader:
      return checked(ReadRigHeader(r));
    case MessageType::kBone:
      return checked(ReadBone(r));
    case MessageType::kChannel:
      return checked(ReadChannel(r));
    case MessageType::kPose:
      return checked(ReadPose(r));
    case MessageType::kStatus:
      return checked(ReadStatus(r));
    case MessageType::kAcknowledgement:
      return checked(ReadAcknowledgement(r));
    case MessageType::kCommand:
      return checked(ReadCommand(r));
    case MessageType::kText:
      return checked(ReadText(r));
    case MessageType::kServoSetup:
      return checked(ReadServoSetup(r));
    case MessageType::kServoPulses:
      return checked(ReadServoPulses(r));
    case MessageType::kLandmarks:
      return checked(ReadLandmarkPart(r));
    case MessageType::kReceiverStatus:
      return checked(ReadReceiverStatus(r));
  }
  return Errc::kUnsupported;
}

}  // namespace

Result<Received> Decoder::Next(std::span<const byte>& bytes) noexcept {
  while (!bytes.empty()) {
    const byte b = bytes.front();
    bytes = bytes.subspan(1);
    if (b != byte{0}) {
      Take(b);
      continue;
    }
    const bool empty = !started_;
    const bool tail = !joined_;  // perhaps a frame whose beginning nobody saw
    joined_ = true;
    if (empty) continue;

    const LinkStats before = stats_;
    const auto received = Finish();
    size_ = 0;
    left_in_block_ = 0;
    zero_pending_ = started_ = overflowed_ = false;
    if (stats_.Damaged() == before.Damaged()) return received;
    if (tail) {
      stats_ = before;
      continue;
    }
    damaged_ = true;
    return received;
  }
  return Errc::kNotReady;
}

// Undoes COBS byte by byte: a code says how many plain bytes follow, and stands for a zero after
// them unless it is 0xFF or nothing follows.
void Decoder::Take(byte b) noexcept {
  started_ = true;
  if (left_in_block_ > 0) {
    --left_in_block_;
    Append(b);
    return;
  }
  if (zero_pending_) Append(byte{0});
  left_in_block_ = static_cast<std::uint8_t>(std::to_integer<unsigned>(b) - 1U);
  zero_pending_ = b != byte{0xFF};
}

void Decoder::Append(byte b) noexcept {
  if (size_ == buffer_.size()) {
    overflowed_ = true;
  } else {
    buffer_[size_++] = b;
  }
}

Result<Received> Decoder::Finish() noexcept {
  if (overflowed_) {
    ++stats_.overflows;
    return Errc::kFull;
  }
  if (left_in_block_ > 0) {
    ++stats_.cobs_errors;
    return Errc::kCorrupt;
  }
  if (size_ < kHeaderBytes + kCrcBytes) {
    ++stats_.truncated;
    return Errc::kTruncated;
  }
  const auto inside = std::span<const byte>(buffer_).first(size_);
  const auto checked = inside.first(size_ - kCrcBytes);
  Crc32 crc;
  crc.Add(checked);
  if (Reader(inside.last(kCrcBytes)).Integer<std::uint32_t>() != crc.value()) {
    ++stats_.crc_errors;
    return Errc::kCorrupt;
  }
  return Check(checked);
}

Result<Received> Decoder::Check(std::span<const byte> checked) noexcept {
  Reader header(checked);
  const auto version = header.Integer<std::uint8_t>();
  const auto type = header.Integer<std::uint8_t>();
  const auto sequence = header.Integer<std::uint16_t>();
  if (damaged_) ++stats_.resyncs;
  damaged_ = false;
  if (version != kVersion) {
    ++stats_.versions;
    return Errc::kVersion;
  }
  CountSequence(sequence);
  const auto message = ReadPayload(type, checked.subspan(kHeaderBytes));
  if (!message) {
    ++(message.error() == Errc::kUnsupported ? stats_.unknown : stats_.malformed);
    return message.error();
  }
  ++stats_.frames;
  return Received{sequence, *message};
}

void Decoder::CountSequence(std::uint16_t sequence) noexcept {
  constexpr int kPeriod = 0xFFFF;  // 1..65535, then 1 again
  if (last_sequence_) {
    const int expected = *last_sequence_ == 0xFFFF ? 1 : *last_sequence_ + 1;
    const int gap = (sequence - expected + kPeriod) % kPeriod;
    // A number from behind is a sender that started again and whose first frame got lost.
    if (sequence == 0 || gap > kPeriod / 2) {
      ++stats_.restarts;
    } else {
      stats_.lost += static_cast<std::uint64_t>(gap);
    }
  }
  last_sequence_ = sequence;
}

}  // namespace facewire::wire
