#include "hal/system_clock.h"

#include <cerrno>
#include <ctime>

namespace facewire::hal {

Time SystemClock::Now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return Time{std::chrono::duration_cast<Duration>(std::chrono::seconds(now.tv_sec) +
                                                   std::chrono::nanoseconds(now.tv_nsec))};
}

void SystemClock::SleepUntil(Time until) {
  constexpr std::int64_t kUsPerSecond = 1'000'000;
  const std::int64_t us = until.time_since_epoch().count();
  if (us <= 0) return;  // before the machine booted
  timespec at{};
  at.tv_sec = static_cast<std::time_t>(us / kUsPerSecond);
  at.tv_nsec = static_cast<long>(us % kUsPerSecond * 1000);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
  }
}

}  // namespace facewire::hal
