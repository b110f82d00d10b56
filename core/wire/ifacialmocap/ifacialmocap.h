#ifndef FACEWIRE_CORE_WIRE_IFACIALMOCAP_IFACIALMOCAP_H_
#define FACEWIRE_CORE_WIRE_IFACIALMOCAP_IFACIALMOCAP_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/wire/arkit/arkit.h"

// iFacialMocap's text, as VSeeFace, Blender and others receive it (UDP 49983). README.md here is
// the specification.
namespace facewire::wire::ifacialmocap {

// What stands between a name and its value. Receivers of the second version take both.
enum class Version : std::uint8_t { kFirst = 1, kSecond = 2 };  // '-', '&'

inline constexpr std::size_t kMaxPacketBytes = 2048;

// One datagram, at the front of `out`. Without a face the values are still sent (`face` is then
// where the rig rests), and trackingStatus says so. kFull (kMaxPacketBytes suffices).
Result<std::span<const std::byte>> Encode(Version version, const arkit::Face& face, bool tracking,
                                          std::span<std::byte> out) noexcept;

}  // namespace facewire::wire::ifacialmocap

#endif  // FACEWIRE_CORE_WIRE_IFACIALMOCAP_IFACIALMOCAP_H_
