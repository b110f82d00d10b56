#ifndef FACEWIRE_HAL_CLOCK_H_
#define FACEWIRE_HAL_CLOCK_H_

#include "core/base/time.h"

namespace facewire::hal {

// The one reader of time. Camera timestamps are on the same base (CLOCK_MONOTONIC on the device).
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time Now() = 0;
  // Returns at once when the time has passed already.
  virtual void SleepUntil(Time until) = 0;
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_CLOCK_H_
