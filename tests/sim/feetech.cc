#include "tests/sim/feetech.h"

#include <algorithm>
#include <numeric>

namespace facewire::sim {
namespace {

enum Instruction : std::uint8_t {
  kPing = 0x01,
  kRead = 0x02,
  kWrite = 0x03,
  kRegWrite = 0x04,
  kAction = 0x05,
  kRecovery = 0x06,
  kReset = 0x0A,
  kSyncRead = 0x82,
  kSyncWrite = 0x83
};
constexpr std::uint8_t kBroadcast = 0xFE;
constexpr Nanos kSilence = 100'000'000;  // after which a packet that is not complete is forgotten
constexpr Nanos kOverhead = 30'000;      // of the servo's processor, on top of its delay

// Everything after the two FF adds up, with the checksum, to FF in its lowest byte.
std::uint8_t Checksum(std::span<const std::uint8_t> id_to_last) {
  const unsigned sum = std::accumulate(id_to_last.begin(), id_to_last.end(), 0U);
  return static_cast<std::uint8_t>(0xFFU - (sum & 0xFFU));
}

}  // namespace

FeetechOptions::FeetechOptions(const FeetechSeries& servo_series) : series(&servo_series) {
  servo = servo_series.servo;
  supply_V = servo_series.supply_V;
}

Feetech::Feetech(const FeetechOptions& options)
    : Bus(options, options.ids.size(), options.series->counts / 2.0,
          options.series->counts / options.series->turn_rad, /*half_duplex=*/true),
      middle_(options.series->counts / 2.0),
      counts_per_rad_(options.series->counts / options.series->turn_rad) {
  chain_.reserve(options.ids.size());
  for (std::size_t i = 0; i < options.ids.size(); ++i) {
    chain_.emplace_back(
        *options.series, options.ids[i], baud(), Bus::servo(i),
        [this, i](EventKind kind, int detail) { Happened(kind, static_cast<int>(i), detail); });
  }
}

bool Feetech::Hears(std::size_t index) const {
  return Answers(index) && chain_[index].baud() == baud();
}

void Feetech::OnMillisecond(Time) {
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    if (Running(i)) chain_[i].Millisecond(supply_V());
  }
}

void Feetech::OnByte(std::uint8_t byte, Nanos at) {
  if (at - last_byte_ > kSilence) packet_.clear();
  last_byte_ = at;
  if (packet_.size() < 2) {
    if (byte == 0xFF)
      packet_.push_back(byte);
    else
      packet_.clear();
    return;
  }
  if (packet_.size() == 2 && byte == 0xFF) return;  // FF FF FF: the last two may be the header
  packet_.push_back(byte);
  if (packet_.size() < 4) return;
  const std::size_t length = packet_[3];
  if (length < 2) {
    packet_.clear();
  } else if (packet_.size() == 4 + length) {
    OnPacket(at);
    packet_.clear();
  }
}

void Feetech::OnPacket(Nanos at) {
  const std::span<const std::uint8_t> all(packet_);
  if (Checksum(all.subspan(2, all.size() - 3)) != all.back()) {
    Happened(EventKind::kDamagedPacket, kWholeBus, 0);  // nobody answers
    return;
  }
  const std::uint8_t id = all[2];
  const std::uint8_t instruction = all[4];
  const std::span<const std::uint8_t> params = all.subspan(5, all.size() - 6);
  if (instruction == kSyncWrite) return SyncWrite(params);
  if (instruction == kSyncRead) return SyncRead(params, at);
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    if (Hears(i) && (id == kBroadcast || id == chain_[i].id())) {
      OnInstruction(i, id == kBroadcast, instruction, params, at);
    }
  }
}

void Feetech::OnInstruction(std::size_t index, bool broadcast, std::uint8_t instruction,
                            std::span<const std::uint8_t> params, Nanos at) {
  FeetechServo& servo = chain_[index];
  const bool answers = !broadcast && servo.Byte(feetech::kResponseLevel) != 0;
  switch (instruction) {
    case kPing:
      Answer(index, {}, at);  // also to a broadcast: on a chain they all talk at once
      return;
    case kRead: {
      if (params.size() != 2 || broadcast) return;
      std::vector<std::uint8_t> bytes(params[1]);
      servo.Read(params[0], bytes, supply_V());
      Answer(index, bytes, at);
      return;
    }
    case kWrite:
      if (!params.empty()) servo.Write(params[0], params.subspan(1));
      break;
    case kRegWrite:
      if (!params.empty()) servo.RegisterWrite(params[0], params.subspan(1));
      break;
    case kAction:
      servo.Action();
      break;
    case kRecovery:
    case kReset:
      Happened(EventKind::kFactoryReset, static_cast<int>(index), instruction);
      servo.FactoryReset();
      break;
    default:
      Happened(EventKind::kProtocol, static_cast<int>(index), instruction);
      return;
  }
  if (answers) Answer(index, {}, at);
}

void Feetech::SyncWrite(std::span<const std::uint8_t> params) {
  if (params.size() < 2) return;
  const std::size_t length = params[1];
  for (std::size_t at = 2; at + 1 + length <= params.size(); at += 1 + length) {
    for (std::size_t i = 0; i < chain_.size(); ++i) {
      if (Hears(i) && chain_[i].id() == params[at]) {
        chain_[i].Write(params[0], params.subspan(at + 1, length));
      }
    }
  }
}

void Feetech::SyncRead(std::span<const std::uint8_t> params, Nanos at) {
  if (params.size() < 3) return;
  for (const std::uint8_t id : params.subspan(2)) {
    Nanos end = Line::kNever;  // after one that is missing, nobody answers
    for (std::size_t i = 0; i < chain_.size(); ++i) {
      if (!Hears(i) || chain_[i].id() != id) continue;
      std::vector<std::uint8_t> bytes(params[1]);
      chain_[i].Read(params[0], bytes, supply_V());
      end = Answer(i, bytes, at);
    }
    if (end == Line::kNever) return;
    at = end;
  }
}

Nanos Feetech::Answer(std::size_t index, std::span<const std::uint8_t> params, Nanos at) {
  const FeetechServo& servo = chain_[index];
  std::vector<std::uint8_t> packet = {0xFF, 0xFF, servo.id(),
                                      static_cast<std::uint8_t>(params.size() + 2), servo.status()};
  packet.insert(packet.end(), params.begin(), params.end());
  packet.push_back(Checksum(std::span(packet).subspan(2)));
  return Reply(packet, at, kOverhead + Nanos{servo.Byte(feetech::kReturnDelay)} * 2000);
}

}  // namespace facewire::sim
