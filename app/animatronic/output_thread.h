#ifndef FACEWIRE_APP_ANIMATRONIC_OUTPUT_THREAD_H_
#define FACEWIRE_APP_ANIMATRONIC_OUTPUT_THREAD_H_

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include "app/animatronic/latest.h"
#include "app/animatronic/servo_output.h"
#include "app/animatronic/servo_report.h"
#include "core/base/capacity.h"
#include "core/base/time.h"
#include "core/servo/mapper.h"
#include "hal/clock.h"

namespace facewire::app {

// Moves the servos at the pace of the fastest bus, in a thread of its own: what the camera and the
// face's networks take must not show in a servo's motion. The service hands its wishes over and
// looks at the report; neither waits for the other. Its scheduling is the process's: the unit
// gives real time to all threads.
class OutputThread {
 public:
  // So often the report is made. People and the power line need no more.
  static constexpr Duration kReportEvery = std::chrono::milliseconds(50);
  // How long letting go may take at the end.
  static constexpr Duration kCloseWithin = std::chrono::milliseconds(500);

  // Both borrowed; `output` is the thread's alone from Begin to End.
  OutputThread(ServoOutput& output, hal::Clock& clock) noexcept;
  ~OutputThread() { End(); }
  OutputThread(const OutputThread&) = delete;
  OutputThread& operator=(const OutputThread&) = delete;

  // Starts the thread. Throws Failure.
  void Begin();
  // Lets go of all servos, closes the ports and waits for the thread's end: at most a tick and
  // kCloseWithin. Without a thread nothing happens.
  void End() noexcept;

  // The service's, from one thread. Wishes that do not come any more are a silence, and the rig's
  // contract takes its course.
  void Hand(const servo::Wishes& wishes) noexcept { wishes_.Put(wishes); }
  // One servo by hand, before all wishes, until it is not repeated any more (servo/aim.h). False
  // for an index beyond the last servo, and for what is no number.
  bool MoveByHand(std::size_t servo, float position) noexcept;
  // From the next tick on nothing moves, until SetStopped(false).
  void SetStopped(bool stopped) noexcept { stopped_.store(stopped); }
  // The newest one; of no servo and no bus before the first.
  const ServoReport& report() noexcept;

  const servo::Contract& contract() const noexcept { return output_.contract(); }

  // One tick, which is all that the thread does; for tests, which have no thread.
  void Step() noexcept;

 private:
  void Run() noexcept;
  void TakeHands(Time now) noexcept;
  void Watch(Time now) noexcept;
  void Report(Time now) noexcept;

  ServoOutput& output_;
  hal::Clock& clock_;
  std::thread thread_;
  std::atomic<bool> ending_{false};
  std::atomic<bool> stopped_{false};
  Latest<servo::Wishes> wishes_;
  std::array<std::atomic<float>, kMaxServos> hands_;  // NaN: nothing new
  static_assert(std::atomic<float>::is_always_lock_free);
  Latest<ServoReport> reports_;

  // The thread's.
  ServoReport next_;
  Time next_report_{};
  std::array<bool, kMaxServos> had_torque_{};  // when it last answered

  const ServoReport* seen_ = nullptr;  // the service's
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_OUTPUT_THREAD_H_
