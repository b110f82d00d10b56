#include "core/wire/osc_host/address.h"

namespace facewire::wire::osc_host {

ValueAddress::ValueAddress(const ShortName& name, ChannelKind kind) noexcept {
  constexpr std::string_view kReserved = "#*,/?[]{}";
  const std::string_view text = name.view();
  const std::size_t dot =
      kind == ChannelKind::kParameter ? std::string_view::npos : text.rfind('.');
  // There is room for the longest name.
  for (char c : kValuePrefix) (void)text_.try_push(c);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool reserved = kReserved.find(text[i]) != std::string_view::npos;
    (void)text_.try_push(i == dot ? '/' : reserved ? '_' : text[i]);
  }
}

}  // namespace facewire::wire::osc_host
