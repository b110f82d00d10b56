#ifndef FACEWIRE_TESTS_CORE_BUS_FEETECH_PEER_H_
#define FACEWIRE_TESTS_CORE_BUS_FEETECH_PEER_H_

#include "tests/core/bus/chain_peer.h"

namespace facewire::bus {

class FeetechPeer : public ChainPeer {
 public:
  bool scs = false;  // high byte first, no acceleration
  int phase = 4;     // fine speeds

 protected:
  std::size_t PacketSize(std::span<const std::byte> bytes) const override;
  void Obey(const Bytes& packet, std::vector<Bytes>& replies) override;

 private:
  int Value(std::span<const std::byte> two) const;
  void Write(int id, int address, std::span<const std::byte> data);
  Bytes Reply(int id, int address, int length);
};

}  // namespace facewire::bus

#endif  // FACEWIRE_TESTS_CORE_BUS_FEETECH_PEER_H_
