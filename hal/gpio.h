#ifndef FACEWIRE_HAL_GPIO_H_
#define FACEWIRE_HAL_GPIO_H_

#include <string_view>

#include "core/base/result.h"

namespace facewire::hal {

// One line of a GPIO chip, held for this program alone. Lines are logical: true means "asserted",
// whatever the electrical polarity, which the backend knows. Not thread-safe.
class GpioLine {
 public:
  virtual ~GpioLine() = default;

  // Takes the line, or takes it again after kDisconnected. A line that is held stays as it is. May
  // block for milliseconds and allocate.
  // kNotFound (no such chip or line), kBusy (somebody holds it), kPermission, kUnsupported (not a
  // GPIO chip, or it cannot do what is asked of the line), kInvalidArgument (several lines fit the
  // description), kDisconnected (it went away just now), kIo.
  virtual Result<> Open() = 0;

  // Why the last call failed, for a person; empty where the code says it all. Until the next call.
  virtual std::string_view reason() const = 0;
};

class GpioInput : public GpioLine {
 public:
  // The line's present level. Allocates nothing. kDisconnected (the chip has gone; also when not
  // open), kIo. The caller treats an unreadable line as the unsafe one.
  virtual Result<bool> Get() = 0;
};

// Not asserted is the safe level: Open begins with it, and destruction ends with it.
class GpioOutput : public GpioLine {
 public:
  // Allocates nothing. kDisconnected (the chip has gone; also when not open), kIo.
  virtual Result<> Set(bool asserted) = 0;
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_GPIO_H_
