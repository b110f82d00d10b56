#include "tests/core/bus/feetech_peer.h"

namespace facewire::bus {
namespace {

int At(std::span<const std::byte> bytes, std::size_t i) { return std::to_integer<int>(bytes[i]); }

}  // namespace

std::size_t FeetechPeer::PacketSize(std::span<const std::byte> bytes) const {
  return bytes.size() < 4 ? bytes.size() : static_cast<std::size_t>(4 + At(bytes, 3));
}

int FeetechPeer::Value(std::span<const std::byte> two) const {
  return scs ? At(two, 0) << 8 | At(two, 1) : At(two, 0) | At(two, 1) << 8;
}

void FeetechPeer::Write(int id, int address, std::span<const std::byte> data) {
  PeerServo* servo = Find(id);
  if (servo == nullptr || servo->deaf) return;
  if (address == 40) {
    Note(Written::What::kTorque, id, At(data, 0), *servo);
    servo->torque = At(data, 0) != 0;
  }
  if (address == 41 && !scs) {
    servo->acceleration = At(data, 0);
    data = data.subspan(1);
    address = 42;
  }
  if (address != 42) return;
  Note(Written::What::kSpeed, id, Value(data.subspan(4, 2)), *servo);
  servo->speed = Value(data.subspan(4, 2));
  Note(Written::What::kGoal, id, Value(data.first(2)), *servo);
  servo->goal = Value(data.first(2));
}

Bytes FeetechPeer::Reply(int id, int address, int length) {
  const PeerServo& servo = servos[id];
  std::array<int, 256> table{};
  const auto put = [&](std::size_t at, int value) {
    table[at] = scs ? value >> 8 : value & 0xFF;
    table[at + 1] = scs ? value & 0xFF : value >> 8;
  };
  put(9, servo.min);
  put(11, servo.max);
  table[18] = phase;
  table[19] = 0x2C;
  table[33] = servo.mode;
  table[40] = servo.torque ? 1 : 0;
  put(42, servo.goal);
  put(46, servo.speed);
  table[scs ? 48 : 55] = servo.lock;
  put(56, servo.position);
  put(60, servo.load);
  table[62] = 74;
  table[63] = servo.temperature;
  table[65] = servo.errors;
  Bytes packet;
  const auto add = [&](int b) { packet.push_back(static_cast<std::byte>(b)); };
  for (int b : {0xFF, 0xFF, id, length + 2, servo.errors}) add(b);
  for (int i = 0; i < length; ++i) add(table[static_cast<std::size_t>(address + i)]);
  int sum = 0;
  for (std::size_t i = 2; i < packet.size(); ++i) sum += At(packet, i);
  add(~sum & 0xFF);
  return packet;
}

void FeetechPeer::Obey(const Bytes& packet, std::vector<Bytes>& replies) {
  const int id = At(packet, 2);
  const auto data = std::span(packet).subspan(5, packet.size() - 6);
  const auto answer = [&](int who) {
    const PeerServo* servo = Find(who);
    if (servo == nullptr || !servo->answers) return false;
    replies.push_back(Reply(who, At(data, 0), At(data, 1)));
    return true;
  };
  switch (At(packet, 4)) {
    case 0x02:
      answer(id);
      return;
    case 0x03:
      for (auto& [who, servo] : servos) {
        if (id == 0xFE || id == who) Write(who, At(data, 0), data.subspan(1));
      }
      return;
    case 0x08:
      if (PeerServo* servo = Find(id)) {
        ++servo->reboots;
        servo->errors = 0;
        servo->torque = false;
        servo->goal = 0;
      }
      return;
    case 0x82:
      for (std::size_t i = 2; i < data.size() && answer(At(data, i)); ++i) {
      }
      return;
    case 0x83: {
      const auto each = static_cast<std::size_t>(At(data, 1));
      for (std::size_t i = 2; i + each < data.size(); i += each + 1) {
        Write(At(data, i), At(data, 0), data.subspan(i + 1, each));
      }
      return;
    }
    default:
      return;
  }
}

}  // namespace facewire::bus
