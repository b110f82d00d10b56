#ifndef FACEWIRE_HAL_GPIOD_FIND_LINE_H_
#define FACEWIRE_HAL_GPIOD_FIND_LINE_H_

#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "hal/gpiod/library.h"

namespace facewire::hal::gpiod {

// How a person names a line.
struct LineName {
  std::string chip;  // its label ("pinctrl-bcm2711"), name ("gpiochip0") or path; empty: any chip
  std::string line;  // its offset in decimal digits, which needs a chip, or its name ("GPIO17")
};

// The number that a text of nothing but digits stands for.
std::optional<unsigned> OffsetOf(std::string_view line) noexcept;

struct Place {
  std::string path;  // of the chip
  unsigned offset = 0;
  LineInfo line;
  std::string text;  // for a person: "line 17 of gpiochip0 (pinctrl-bcm2711)"
};

// kNotFound, kPermission, kInvalidArgument (several chips or lines fit, or an offset without a
// chip), kUnsupported (a path that is no GPIO chip), kIo. `reason` then says for a person what is
// there instead.
Result<Place> FindLine(Library& library, const LineName& name, std::string& reason);

}  // namespace facewire::hal::gpiod

#endif  // FACEWIRE_HAL_GPIOD_FIND_LINE_H_
