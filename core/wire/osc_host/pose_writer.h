#ifndef FACEWIRE_CORE_WIRE_OSC_HOST_POSE_WRITER_H_
#define FACEWIRE_CORE_WIRE_OSC_HOST_POSE_WRITER_H_

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/capacity.h"
#include "core/base/result.h"
#include "core/rig/rig.h"
#include "core/wire/message.h"

namespace facewire::wire::osc_host {

// A pose as bundles of OSC messages, one for each value, and one at the end that says that these
// were all. OSC takes 20 times the bytes of the native protocol, so a pose has what fits the line:
// a few values in turn, so that a receiver which joins late or lost a packet has all of them soon;
// then those that changed, the most first.
class PoseWriter {
 public:
  // Values of every pose that come in turn, changed or not.
  static constexpr std::size_t kInTurn = 4;
  // A pose of no changed value fits; with less room there is none.
  static constexpr std::size_t kLeastRoom = 128;

  // The rig that poses belong to; borrowed. The receiver has nothing of it yet.
  void SetRig(const Rig& rig) noexcept;
  // The receiver has nothing yet: the line was opened.
  void Forget() noexcept { known_.reset(); }

  // Begins a pose that takes about `room` bytes of the line, at most a message more. Borrowed until
  // Next says kEnd. False: not even the smallest fits.
  bool Begin(const Pose& pose, std::size_t room) noexcept;
  // The next packet, in SLIP at the front of `out`. Asking for it says that the line took the one
  // before. kEnd: that was the pose; kFull (MaxSlipBytes(kMaxPacketBytes) always suffices).
  Result<std::span<const std::byte>> Next(std::span<std::byte> out) noexcept;

 private:
  void Plan() noexcept;
  std::uint32_t ChangeOf(std::size_t channel) const noexcept;

  const Rig* rig_ = nullptr;
  const Pose* pose_ = nullptr;
  std::array<std::uint16_t, kMaxChannels> sent_{};  // steps that the receiver has
  std::bitset<kMaxChannels> known_;                 // of sent_
  std::size_t turn_ = 0;                            // the channel whose turn is next
  std::array<std::uint8_t, kMaxChannels> plan_{};   // channels in the order of going out
  std::size_t planned_ = 0;
  std::size_t at_ = 0;     // of plan_, the next
  std::size_t taken_ = 0;  // of plan_, up to here the line took them
  std::size_t room_ = 0;
  bool ended_ = false;
};

}  // namespace facewire::wire::osc_host

#endif  // FACEWIRE_CORE_WIRE_OSC_HOST_POSE_WRITER_H_
