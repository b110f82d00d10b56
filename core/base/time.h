#ifndef FACEWIRE_CORE_BASE_TIME_H_
#define FACEWIRE_CORE_BASE_TIME_H_

#include <chrono>
#include <cstdint>

namespace facewire {

// The time base of everything on the frame path: microseconds since an arbitrary, fixed origin;
// never steps backwards with the calendar. core only ever receives it as a value; hal::Clock reads
// it.
struct MonotonicClock {
  using rep = std::int64_t;
  using period = std::micro;
  using duration = std::chrono::microseconds;
  using time_point = std::chrono::time_point<MonotonicClock, duration>;
  // NOLINTNEXTLINE(readability-identifier-naming): the standard's clock requirements name it so.
  static constexpr bool is_steady = true;
};

using Duration = MonotonicClock::duration;
using Time = MonotonicClock::time_point;

// to - from; the longest Duration of that sign where the difference does not fit (times from a
// broken source).
constexpr Duration Between(Time from, Time to) noexcept {
  const Duration a = from.time_since_epoch();
  const Duration b = to.time_since_epoch();
  if (a < Duration::zero() && b > Duration::max() + a) return Duration::max();
  if (a > Duration::zero() && b < Duration::min() + a) return Duration::min();
  return b - a;
}

constexpr float Seconds(Duration d) noexcept { return static_cast<float>(d.count()) * 1e-6F; }

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_TIME_H_
