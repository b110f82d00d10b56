#ifndef FACEWIRE_TESTS_CORE_BUS_CHAIN_PEER_H_
#define FACEWIRE_TESTS_CORE_BUS_CHAIN_PEER_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace facewire::bus {

using Bytes = std::vector<std::byte>;

// A servo at the other end of the line, by what it means and not by registers.
struct PeerServo {
  bool answers = true;
  bool deaf = false;  // to what is written
  bool torque = false;
  int position = 2048;
  int goal = 0;   // what a servo wakes up with, and must never go to
  int speed = 0;  // its register
  int acceleration = 0;
  int watchdog = 0;
  int temperature = 30;
  int load = 0;    // 0.1 %
  int errors = 0;  // bits as on the wire
  int mode = 0;    // from the normal one
  int min = 1000, max = 3000;
  int lock = 1;
  int reboots = 0;
};

// What was written to one servo.
struct Written {
  enum class What { kGoal, kTorque, kSpeed, kWatchdog };
  What what = What::kGoal;
  int id = 0;
  int value = 0;
  bool torque = false;  // the servo had it before
};

// A chain of servos that hears packets and answers; its protocol is a subclass's. A second, plain
// reading of the specification: whole packets only, one after the other.
class ChainPeer {
 public:
  virtual ~ChainPeer() = default;

  std::map<int, PeerServo> servos;
  std::vector<Written> written;
  std::vector<Bytes> packets;  // all that was heard
  // Packets are lost while this returns true.
  bool (*lose)(std::size_t packet) = nullptr;

  // What all servos that are asked answer, one reply each.
  std::vector<Bytes> Hear(std::span<const std::byte> bytes) {
    std::vector<Bytes> replies;
    while (!bytes.empty()) {
      const std::size_t size = std::min(PacketSize(bytes), bytes.size());
      const Bytes packet(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      bytes = bytes.subspan(size);
      packets.push_back(packet);
      if (lose == nullptr || !lose(packets.size() - 1)) Obey(packet, replies);
    }
    return replies;
  }

  // Servos with torque go to their goals, with at most `step` counts.
  void Move(int step) {
    for (auto& [id, servo] : servos) {
      if (servo.torque) servo.position += std::clamp(servo.goal - servo.position, -step, step);
    }
  }

 protected:
  virtual std::size_t PacketSize(std::span<const std::byte> bytes) const = 0;
  virtual void Obey(const Bytes& packet, std::vector<Bytes>& replies) = 0;

  PeerServo* Find(int id) {
    const auto found = servos.find(id);
    return found == servos.end() ? nullptr : &found->second;
  }
  void Note(Written::What what, int id, int value, const PeerServo& servo) {
    written.push_back({what, id, value, servo.torque});
  }
};

}  // namespace facewire::bus

#endif  // FACEWIRE_TESTS_CORE_BUS_CHAIN_PEER_H_
