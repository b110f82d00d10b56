#ifndef FACEWIRE_CORE_WIRE_OSC_HOST_ADDRESS_H_
#define FACEWIRE_CORE_WIRE_OSC_HOST_ADDRESS_H_

#include <cstddef>
#include <string_view>

#include "core/base/inline_vector.h"
#include "core/base/name.h"
#include "core/rig/rig.h"

namespace facewire::wire::osc_host {

inline constexpr std::string_view kValuePrefix = "/face/";

// The OSC address of a channel's value: "/face/jawOpen", and of the bone channel "jaw.pitch"
// "/face/jaw/pitch". What OSC keeps for itself (# * , / ? [ ] { }) becomes '_'.
class ValueAddress {
 public:
  ValueAddress(const ShortName& name, ChannelKind kind) noexcept;
  std::string_view view() const noexcept { return {text_.begin(), text_.size()}; }

 private:
  InlineVector<char, kValuePrefix.size() + kMaxNameLength> text_;
};

}  // namespace facewire::wire::osc_host

#endif  // FACEWIRE_CORE_WIRE_OSC_HOST_ADDRESS_H_
