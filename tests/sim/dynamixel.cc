#include "tests/sim/dynamixel.h"

#include <algorithm>
#include <array>

namespace facewire::sim {

using dynamixel::Code;

namespace {

enum Instruction : std::uint8_t {
  kPing = 0x01,
  kRead = 0x02,
  kWrite = 0x03,
  kRegWrite = 0x04,
  kAction = 0x05,
  kFactoryReset = 0x06,
  kReboot = 0x08,
  kClear = 0x10,
  kStatus = 0x55,
  kSyncRead = 0x82,
  kSyncWrite = 0x83,
  kBulkRead = 0x92,
  kBulkWrite = 0x93
};
constexpr std::uint8_t kBroadcast = 0xFE;
constexpr std::size_t kHeader = 7;       // up to the length
constexpr std::size_t kLongest = 1024;   // assumed, as all times here (README.md)
constexpr Nanos kSilence = 100'000'000;  // after which a packet that is not complete is forgotten
constexpr Nanos kPingSlot = 3'000'000;   // of each id, in the answer to a broadcast ping
constexpr Nanos kOverhead = 20'000;      // of the servo's processor, on top of Return Delay Time
constexpr Duration kRebootTakes{300'000};

// The polynomial is x^16 + x^15 + x^2 + 1, most significant bit first.
std::uint16_t Crc(std::span<const std::uint8_t> bytes) {
  unsigned remainder = 0;
  for (const std::uint8_t byte : bytes) {
    for (unsigned mask = 0x80; mask != 0; mask >>= 1U) {
      const bool out = (remainder & 0x8000U) != 0;
      remainder = (remainder << 1U) & 0xFFFFU;
      if (out != ((byte & mask) != 0)) remainder ^= 0x8005U;
    }
  }
  return static_cast<std::uint16_t>(remainder);
}

std::uint16_t Word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U);
}

// `stuffed` without the FD that follows every FF FF FD.
std::vector<std::uint8_t> Unstuffed(std::span<const std::uint8_t> stuffed) {
  std::vector<std::uint8_t> plain;
  for (std::size_t i = 0; i < stuffed.size(); ++i) {
    plain.push_back(stuffed[i]);
    const bool mark =
        i >= 2 && stuffed[i] == 0xFD && stuffed[i - 1] == 0xFF && stuffed[i - 2] == 0xFF;
    if (mark && i + 1 < stuffed.size() && stuffed[i + 1] == 0xFD) ++i;
  }
  return plain;
}

std::vector<std::uint8_t> StatusPacket(std::uint8_t id, std::uint8_t error,
                                       std::span<const std::uint8_t> params) {
  std::vector<std::uint8_t> packet = {0xFF, 0xFF, 0xFD, 0x00, id, 0, 0, kStatus, error};
  for (const std::uint8_t byte : params) {
    packet.push_back(byte);
    const std::size_t n = packet.size();
    if (n > kHeader + 3 && byte == 0xFD && packet[n - 2] == 0xFF && packet[n - 3] == 0xFF) {
      packet.push_back(0xFD);
    }
  }
  const std::size_t length = packet.size() - kHeader + 2;
  packet[5] = static_cast<std::uint8_t>(length & 0xFFU);
  packet[6] = static_cast<std::uint8_t>(length >> 8U);
  const std::uint16_t crc = Crc(packet);
  packet.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  packet.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return packet;
}

}  // namespace

DynamixelOptions::DynamixelOptions(const DynamixelModel& servo_model) : model(&servo_model) {
  servo = servo_model.servo;
  supply_V = servo_model.supply_V;
  baud = 57600;
}

Dynamixel::Dynamixel(const DynamixelOptions& options)
    : Bus(options, options.ids.size(), 2048, kCountsPerRad, /*half_duplex=*/true) {
  chain_.reserve(options.ids.size());
  for (std::size_t i = 0; i < options.ids.size(); ++i) {
    chain_.emplace_back(
        *options.model, options.holds_at_torque_on, Bus::servo(i),
        [this, i](EventKind kind, int detail) { Happened(kind, static_cast<int>(i), detail); });
    DynamixelTable& table = chain_[i].table();
    table.Set(dynamixel::kId, options.ids[i]);
    for (std::int32_t rate = 0; rate < 8 && chain_[i].baud() != baud(); ++rate) {
      table.Set(dynamixel::kBaudRate, rate);
    }
    chain_[i].Start();
  }
}

std::int32_t Dynamixel::Entry(std::size_t index, std::uint16_t address) {
  chain_[index].Measure(supply_V());
  return chain_[index].table().Get(address);
}

void Dynamixel::SetEntry(std::size_t index, std::uint16_t address, std::int32_t value) {
  chain_[index].table().Set(address, value);
}

bool Dynamixel::Hears(std::size_t index) const {
  return Answers(index) && chain_[index].baud() == baud();
}

int Dynamixel::IndexOf(std::uint8_t id) const {
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    if (chain_[i].id() == id && Hears(i)) return static_cast<int>(i);
  }
  return -1;
}

void Dynamixel::OnMillisecond(Time) {
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    if (Running(i)) chain_[i].Millisecond(supply_V());
  }
}

void Dynamixel::OnByte(std::uint8_t byte, Nanos at) {
  constexpr std::array<std::uint8_t, 4> kStart = {0xFF, 0xFF, 0xFD, 0x00};
  if (at - last_byte_ > kSilence) packet_.clear();
  last_byte_ = at;
  if (packet_.size() < 4) {
    packet_.push_back(byte);
    // Of what does not fit, the end may still be the start of a packet: FF FF FF FD.
    while (!packet_.empty() && !std::equal(packet_.begin(), packet_.end(), kStart.begin())) {
      packet_.erase(packet_.begin());
    }
    return;
  }
  packet_.push_back(byte);
  if (packet_.size() < kHeader) return;
  const std::size_t length = Word(packet_, 5);
  if (length < 3 || length > kLongest) {
    packet_.clear();
  } else if (packet_.size() == kHeader + length) {
    OnPacket(at);
    packet_.clear();
  }
}

void Dynamixel::OnPacket(Nanos at) {
  const std::span<const std::uint8_t> all(packet_);
  const std::uint8_t id = all[4];
  if (Crc(all.first(all.size() - 2)) != Word(all, all.size() - 2)) {
    Happened(EventKind::kDamagedPacket, kWholeBus, 0);
    const int index = IndexOf(id);
    if (index >= 0) Answer(static_cast<std::size_t>(index), Code::kCrc, {}, at);
    return;
  }
  const std::vector<std::uint8_t> body = Unstuffed(all.subspan(kHeader, all.size() - kHeader - 2));
  if (body.front() == kStatus) return;  // another servo's
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    if (Hears(i)) chain_[i].FeedWatchdog();
  }
  OnInstruction(id, body.front(), std::span(body).subspan(1), at);
}

void Dynamixel::OnInstruction(std::uint8_t id, std::uint8_t instruction,
                              std::span<const std::uint8_t> params, Nanos at) {
  if (id == kBroadcast) {
    switch (instruction) {
      case kPing:
        return PingAll(at);
      case kSyncRead:
        return SyncRead(params, at);
      case kSyncWrite:
        return SyncWrite(params);
      case kBulkRead:
        return BulkRead(params, at);
      case kBulkWrite:
        return BulkWrite(params);
      default:
        break;
    }
  }
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    if (Hears(i) && (id == kBroadcast || id == chain_[i].id())) {
      Single(i, id == kBroadcast, instruction, params, at);
    }
  }
}

// Every servo has its own time to answer, so that they do not talk at once.
void Dynamixel::PingAll(Nanos at) {
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    if (Hears(i)) Single(i, false, kPing, {}, at + kPingSlot * chain_[i].id());
  }
}

void Dynamixel::SyncRead(std::span<const std::uint8_t> params, Nanos at) {
  if (params.size() < 5) return;
  // A servo answers when the one before it in the list has: after one that is missing, nobody does.
  for (std::size_t i = 4; i < params.size() && at != Line::kNever; ++i) {
    at = AnswerRead(params[i], Word(params, 0), Word(params, 2), at);
  }
}

void Dynamixel::BulkRead(std::span<const std::uint8_t> params, Nanos at) {
  for (std::size_t i = 0; i + 5 <= params.size() && at != Line::kNever; i += 5) {
    at = AnswerRead(params[i], Word(params, i + 1), Word(params, i + 3), at);
  }
}

void Dynamixel::SyncWrite(std::span<const std::uint8_t> params) {
  if (params.size() < 4) return;
  const std::size_t length = Word(params, 2);
  for (std::size_t i = 4; i + 1 + length <= params.size(); i += 1 + length) {
    const int index = IndexOf(params[i]);
    if (index >= 0)
      chain_[static_cast<std::size_t>(index)].Write(Word(params, 0), params.subspan(i + 1, length));
  }
}

void Dynamixel::BulkWrite(std::span<const std::uint8_t> params) {
  std::size_t i = 0;
  while (i + 5 <= params.size()) {
    const std::size_t length = Word(params, i + 3);
    if (i + 5 + length > params.size()) return;
    const int index = IndexOf(params[i]);
    if (index >= 0)
      chain_[static_cast<std::size_t>(index)].Write(Word(params, i + 1),
                                                    params.subspan(i + 5, length));
    i += 5 + length;
  }
}

Nanos Dynamixel::AnswerRead(std::uint8_t id, std::uint16_t address, std::uint16_t length,
                            Nanos at) {
  const int found = IndexOf(id);
  if (found < 0) return Line::kNever;
  const auto index = static_cast<std::size_t>(found);
  if (chain_[index].table().Get(dynamixel::kStatusReturnLevel) < 1) return Line::kNever;
  chain_[index].Measure(supply_V());
  std::vector<std::uint8_t> bytes(length);
  const Code code = chain_[index].table().Read(address, bytes);
  if (code != Code::kNone) bytes.clear();
  return Answer(index, code, bytes, at);
}

Nanos Dynamixel::Answer(std::size_t index, Code code, std::span<const std::uint8_t> params,
                        Nanos at) {
  const DynamixelServo& servo = chain_[index];
  const Nanos delay = kOverhead + Nanos{servo.table().Get(dynamixel::kReturnDelay)} * 2000;
  return Reply(StatusPacket(servo.id(), servo.Status(code), params), at, delay);
}

void Dynamixel::Single(std::size_t index, bool broadcast, std::uint8_t instruction,
                       std::span<const std::uint8_t> params, Nanos at) {
  DynamixelServo& servo = chain_[index];
  Code code = Code::kNone;
  const bool has_address = params.size() >= 2;
  switch (instruction) {
    case kPing: {
      const auto model = static_cast<std::uint16_t>(servo.table().Get(dynamixel::kModelNumber));
      const std::array<std::uint8_t, 3> about = {
          static_cast<std::uint8_t>(model & 0xFFU), static_cast<std::uint8_t>(model >> 8U),
          static_cast<std::uint8_t>(servo.table().Get(dynamixel::kFirmware))};
      Answer(index, Code::kNone, about, at);
      return;
    }
    case kRead:
      if (!broadcast && params.size() == 4)
        AnswerRead(servo.id(), Word(params, 0), Word(params, 2), at);
      return;
    case kWrite:
      code = has_address ? servo.Write(Word(params, 0), params.subspan(2)) : Code::kLength;
      break;
    case kRegWrite:
      code = has_address ? servo.RegisterWrite(Word(params, 0), params.subspan(2)) : Code::kLength;
      break;
    case kAction:
      code = servo.Action();
      break;
    case kFactoryReset: {
      const std::uint8_t option = params.empty() ? 0xFF : params[0];
      if (broadcast && option == 0xFF) return;  // would give every servo the same id
      Happened(EventKind::kFactoryReset, static_cast<int>(index), option);
      if (!broadcast) Answer(index, code, {}, at);
      servo.FactoryReset(option);
      StartAnew(index, kRebootTakes);
      return;
    }
    case kReboot:
      Happened(EventKind::kReboot, static_cast<int>(index), 0);
      if (!broadcast) Answer(index, code, {}, at);
      StartAnew(index, kRebootTakes);
      return;
    case kClear:
      code = servo.ClearTurns();
      break;
    default:
      code = Code::kInstruction;
      break;
  }
  const bool answers = servo.table().Get(dynamixel::kStatusReturnLevel) == 2;
  if (!broadcast && answers) Answer(index, code, {}, at);
}

}  // namespace facewire::sim
