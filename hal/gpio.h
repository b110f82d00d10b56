#ifndef FACEWIRE_HAL_GPIO_H_
#define FACEWIRE_HAL_GPIO_H_

#include "core/base/result.h"

namespace facewire::hal {

// Lines are logical: true means "asserted", whatever the electrical polarity, which the backend
// knows.

class GpioInput {
 public:
  virtual ~GpioInput() = default;
  // The line's present level. kDisconnected, kIo: the caller treats an unreadable line as the
  // unsafe one.
  virtual Result<bool> Get() = 0;
};

class GpioOutput {
 public:
  virtual ~GpioOutput() = default;
  // kDisconnected, kIo.
  virtual Result<> Set(bool asserted) = 0;
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_GPIO_H_
