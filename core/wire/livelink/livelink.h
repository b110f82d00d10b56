#ifndef FACEWIRE_CORE_WIRE_LIVELINK_LIVELINK_H_
#define FACEWIRE_CORE_WIRE_LIVELINK_LIVELINK_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/wire/arkit/arkit.h"

// Live Link Face, as Unreal Engine receives it (UDP 11111). README.md here is the specification.
namespace facewire::wire::livelink {

inline constexpr std::uint8_t kVersion = 6;
inline constexpr std::uint8_t kValues = 61;  // the shapes; yaw, pitch and roll of head and eyes
inline constexpr std::size_t kMaxTextBytes = 64;  // of the device's id, and of the subject's name
inline constexpr std::size_t kMaxPacketBytes =
    1 + 2 * (4 + kMaxTextBytes) + 16 + 1 + 4 * std::size_t{kValues};

// The rate that frame numbers count at, whatever the camera's is: a capture that lies between two
// frames has a part of a frame.
inline constexpr std::int32_t kTimecodeHz = 60;

struct Subject {
  std::string_view device_id;  // stays the same for one device; 1 to kMaxTextBytes
  std::string_view name;       // what Unreal lists; 1 to kMaxTextBytes
};

// One datagram, at the front of `out`. `face` is null while there is none: the packet then has no
// values, and Unreal keeps the last. `captured` becomes a timecode that starts again each day of
// the device's clock. kOutOfRange: a text is empty or too long; kFull (kMaxPacketBytes suffices).
Result<std::span<const std::byte>> Encode(const Subject& subject, Time captured,
                                          const arkit::Face* face,
                                          std::span<std::byte> out) noexcept;

}  // namespace facewire::wire::livelink

#endif  // FACEWIRE_CORE_WIRE_LIVELINK_LIVELINK_H_
