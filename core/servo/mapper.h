#ifndef FACEWIRE_CORE_SERVO_MAPPER_H_
#define FACEWIRE_CORE_SERVO_MAPPER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"
#include "core/servo/servo_rig.h"

namespace facewire::servo {

// Where every servo of a ServoRig should be, in its order and in each servo's own unit.
struct Wishes {
  std::uint64_t seq = 0;  // of the frame it answers
  Time captured{};        // of that frame
  std::size_t count = 0;
  std::array<float, kMaxServos> positions{};  // NaN: no wish for this servo
};
static_assert(std::is_trivially_copyable_v<Wishes>);

// From the channels of a rig to the positions of its servos: position = map(offset + sum).
class Mapper {
 public:
  // Both are copied from, not kept. kNotFound: a source names no channel of the rig; kOutOfRange:
  // any other flaw (FindFlaw says which); nothing is changed then.
  Result<> Configure(const ServoRig& servos, const Rig& rig) noexcept;

  // Every position lies within its servo's min to max, or is NaN: of a servo without sources, and
  // where a source is missing in the pose or is not a number. An infinite source means the end of
  // the map.
  Wishes Map(const RigPose& pose) const noexcept;

 private:
  InlineVector<Servo, kMaxServos> servos_;
  std::array<std::array<std::size_t, kMaxDrives>, kMaxServos> channels_{};  // of their sources
};

}  // namespace facewire::servo

#endif  // FACEWIRE_CORE_SERVO_MAPPER_H_
