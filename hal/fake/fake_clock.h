#ifndef FACEWIRE_HAL_FAKE_FAKE_CLOCK_H_
#define FACEWIRE_HAL_FAKE_FAKE_CLOCK_H_

#include "hal/clock.h"

namespace facewire::hal::fake {

// Time that moves only when told. A sleep is over at once and leaves the clock at its end, so hours
// of service pass in a test's blink. Not thread-safe.
class FakeClock final : public Clock {
 public:
  explicit FakeClock(Time start = Time{}) noexcept : now_(start) {}

  Time Now() override { return now_; }
  void SleepUntil(Time until) override {
    if (until > now_) now_ = until;
  }
  void Advance(Duration by) noexcept { now_ += by; }

 private:
  Time now_;
};

}  // namespace facewire::hal::fake

#endif  // FACEWIRE_HAL_FAKE_FAKE_CLOCK_H_
