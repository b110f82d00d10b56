#ifndef FACEWIRE_CORE_BASE_TIME_H_
#define FACEWIRE_CORE_BASE_TIME_H_

#include <chrono>
#include <cstdint>

namespace facewire {

// The time base of everything on the frame path: microseconds since an arbitrary, fixed origin;
// never steps backwards with the calendar. core only ever receives it as a value; hal::Clock reads it.
struct MonotonicClock {
  using rep = std::int64_t;
  using period = std::micro;
  using duration = std::chrono::microseconds;
  using time_point = std::chrono::time_point<MonotonicClock, duration>;
  static constexpr bool is_steady = true;
};

using Duration = MonotonicClock::duration;
using Time = MonotonicClock::time_point;

constexpr float Seconds(Duration d) noexcept { return static_cast<float>(d.count()) * 1e-6F; }

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_TIME_H_
