#ifndef FACEWIRE_CORE_WIRE_RIG_DESCRIPTION_H_
#define FACEWIRE_CORE_WIRE_RIG_DESCRIPTION_H_

#include <bitset>
#include <cstddef>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/base/result.h"
#include "core/rig/rig.h"
#include "core/wire/message.h"

namespace facewire::wire {

// A number that names the description: equal rigs have equal numbers, and any change of a name,
// order, kind, bone, rest position or range changes it (but for one chance in 2^32). Drives,
// landmarks and speed limits do not reach the host and do not count. Compute it once, when the rig
// is loaded.
std::uint32_t RigId(const Rig& rig) noexcept;

// Messages that describe the rig: one header, then bones, then channels.
inline std::size_t DescriptionCount(const Rig& rig) noexcept {
  return 1 + rig.bones.size() + rig.channels.size();
}

// The index'th of them. kOutOfRange: index is not below DescriptionCount(rig).
Result<Message> Description(const Rig& rig, std::uint32_t rig_id, std::size_t index) noexcept;

// The host's side: puts a rig together from messages in any order, with repeats and other messages
// between them. Landmarks are -1; drives and speed limits are empty.
class RigCollector {
 public:
  // True when the message was part of a description. A part with another rig_id than the parts
  // before it starts again: the rig has changed.
  bool Add(const Message& message) noexcept;

  bool Complete() const noexcept;
  std::size_t missing()
      const noexcept;  // parts still to come; at least 1 until the header is there
  std::uint32_t rig_id() const noexcept { return rig_id_; }
  const Rig& rig() const noexcept { return rig_; }  // meaningful when Complete()

 private:
  void StartOver(std::uint32_t rig_id) noexcept;

  Rig rig_;
  std::uint32_t rig_id_ = 0;
  bool any_ = false;
  bool has_header_ = false;
  std::bitset<kMaxBones> has_bone_;
  std::bitset<kMaxChannels> has_channel_;
};

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_RIG_DESCRIPTION_H_
