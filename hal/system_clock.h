#ifndef FACEWIRE_HAL_SYSTEM_CLOCK_H_
#define FACEWIRE_HAL_SYSTEM_CLOCK_H_

#include "hal/clock.h"

namespace facewire::hal {

// The machine's CLOCK_MONOTONIC: V4L2 drivers stamp their frames with the same clock. It stands
// still while the machine is suspended. Safe to share between threads.
class SystemClock final : public Clock {
 public:
  Time Now() override;
  // Sleeps to an absolute time, so a signal or a late wake-up never adds up to drift.
  void SleepUntil(Time until) override;
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_SYSTEM_CLOCK_H_
