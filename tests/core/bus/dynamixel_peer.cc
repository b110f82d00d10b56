#include "tests/core/bus/dynamixel_peer.h"

namespace facewire::bus {
namespace {

int At(std::span<const std::byte> bytes, std::size_t i) { return std::to_integer<int>(bytes[i]); }
int At16(std::span<const std::byte> bytes, std::size_t i) {
  return At(bytes, i) | At(bytes, i + 1) << 8;
}

int Crc(const Bytes& bytes) {
  unsigned crc = 0;
  for (std::byte b : bytes) {
    crc ^= std::to_integer<unsigned>(b) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      crc = ((crc & 0x8000U) != 0 ? crc << 1U ^ 0x8005U : crc << 1U) & 0xFFFFU;
    }
  }
  return static_cast<int>(crc);
}

}  // namespace

std::size_t DynamixelPeer::PacketSize(std::span<const std::byte> bytes) const {
  return bytes.size() < 7 ? bytes.size() : static_cast<std::size_t>(7 + At16(bytes, 5));
}

void DynamixelPeer::Write(int id, int address, std::span<const std::byte> data) {
  PeerServo* servo = Find(id);
  if (servo == nullptr || servo->deaf) return;
  int value = 0;
  for (std::size_t i = 0; i < data.size() && i < 4; ++i)
    value |= At(data, i) << (8 * static_cast<int>(i));
  const bool tripped = servo->watchdog == 255;
  switch (address) {
    case 64:
      Note(Written::What::kTorque, id, value, *servo);
      servo->torque = value != 0;
      break;
    case 98:
      Note(Written::What::kWatchdog, id, value, *servo);
      servo->watchdog = value;
      break;
    case 108:  // acceleration and velocity
      servo->acceleration = At(data, 0) | At(data, 1) << 8;
      value = At(data, 4) | At(data, 5) << 8;
      Note(Written::What::kSpeed, id, value, *servo);
      servo->speed = value;
      break;
    case kGoalAddress:
      if (tripped) break;
      Note(Written::What::kGoal, id, value, *servo);
      servo->goal = value;
      break;
    default:
      break;
  }
}

// Whether a table of the X series names all these bytes; the XL430's, which has no current limit.
bool DynamixelPeer::IsNamed(int address, int length) {
  constexpr std::array<std::pair<int, int>, 14> kNamed = {{{0, 14},
                                                           {20, 8},
                                                           {31, 7},
                                                           {44, 12},
                                                           {60, 1},
                                                           {63, 3},
                                                           {68, 3},
                                                           {76, 10},
                                                           {88, 4},
                                                           {98, 1},
                                                           {100, 2},
                                                           {104, 18},
                                                           {122, 26},
                                                           {168, 84}}};
  return std::ranges::any_of(kNamed, [&](const auto& range) {
    return address >= range.first && address + length <= range.first + range.second;
  });
}

Bytes DynamixelPeer::Reply(int id, int error, int address, int length) {
  if (!IsNamed(address, length)) {
    error = 7;
    length = 0;
  }
  const PeerServo& servo = servos[id];
  std::array<int, 256> table{};
  const auto put = [&](int at, int bytes, int value) {
    for (int i = 0; i < bytes; ++i) {
      table[static_cast<std::size_t>(at + i)] = value >> (8 * i) & 0xFF;
    }
  };
  put(0, 2, 1060);
  put(9, 1, 250);
  put(10, 1, drive_mode);
  put(11, 1, 3 + servo.mode);
  put(48, 4, servo.max);
  put(52, 4, servo.min);
  put(63, 1, 0x34);
  put(64, 1, servo.torque ? 1 : 0);
  put(68, 1, 2);
  put(70, 1, servo.errors);
  put(98, 1, servo.watchdog);
  put(108, 4, servo.acceleration);
  put(112, 4, servo.speed);
  put(116, 4, servo.goal);
  put(126, 2, servo.load);
  put(132, 4, servo.position);
  put(144, 2, 111);
  put(146, 1, servo.temperature);
  Bytes packet;
  const auto add = [&](int b) { packet.push_back(static_cast<std::byte>(b)); };
  for (int b : {0xFF, 0xFF, 0xFD, 0x00, id, (length + 4) & 0xFF, (length + 4) >> 8, 0x55,
                error | (servo.errors != 0 ? 0x80 : 0)}) {
    add(b);
  }
  for (int i = 0; i < length; ++i) add(table[static_cast<std::size_t>(address + i)]);
  const int crc = Crc(packet);
  add(crc & 0xFF);
  add(crc >> 8);
  return packet;
}

void DynamixelPeer::Obey(const Bytes& packet, std::vector<Bytes>& replies) {
  const int id = At(packet, 4);
  const int instruction = At(packet, 7);
  const auto data = std::span(packet).subspan(8, packet.size() - 10);
  const auto answers = [&](int who) {
    const PeerServo* servo = Find(who);
    return servo != nullptr && servo->answers;
  };
  switch (instruction) {
    case 0x02:
      if (answers(id)) replies.push_back(Reply(id, 0, At16(data, 0), At16(data, 2)));
      return;
    case 0x03:
      for (auto& [who, servo] : servos) {
        if (id == 0xFE || id == who) Write(who, At16(data, 0), data.subspan(2));
      }
      return;
    case 0x08:
      if (PeerServo* servo = Find(id)) {
        ++servo->reboots;
        servo->errors = 0;
        servo->torque = false;
        servo->goal = 0;
        servo->watchdog = 0;
      }
      return;
    case 0x82:
      // Each waits for the one before it: a gap silences the rest.
      for (std::size_t i = 4; i < data.size() && answers(At(data, i)); ++i) {
        replies.push_back(Reply(At(data, i), 0, At16(data, 0), At16(data, 2)));
      }
      return;
    case 0x83: {
      const auto each = static_cast<std::size_t>(At16(data, 2));
      for (std::size_t i = 4; i + each < data.size(); i += each + 1) {
        Write(At(data, i), At16(data, 0), data.subspan(i + 1, each));
      }
      return;
    }
    default:
      return;
  }
}

}  // namespace facewire::bus
