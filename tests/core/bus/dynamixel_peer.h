#ifndef FACEWIRE_TESTS_CORE_BUS_DYNAMIXEL_PEER_H_
#define FACEWIRE_TESTS_CORE_BUS_DYNAMIXEL_PEER_H_

#include "tests/core/bus/chain_peer.h"

namespace facewire::bus {

// Dynamixels of the X series. No packet of these tests needs stuffing.
class DynamixelPeer : public ChainPeer {
 public:
  static constexpr int kGoalAddress = 116;
  int drive_mode = 0;

 protected:
  std::size_t PacketSize(std::span<const std::byte> bytes) const override;
  void Obey(const Bytes& packet, std::vector<Bytes>& replies) override;

 private:
  void Write(int id, int address, std::span<const std::byte> data);
  static bool IsNamed(int address, int length);
  Bytes Reply(int id, int error, int address, int length);
};

}  // namespace facewire::bus

#endif  // FACEWIRE_TESTS_CORE_BUS_DYNAMIXEL_PEER_H_
