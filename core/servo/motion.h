#ifndef FACEWIRE_CORE_SERVO_MOTION_H_
#define FACEWIRE_CORE_SERVO_MOTION_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/servo/aim.h"
#include "core/servo/axis.h"
#include "core/servo/linkages.h"
#include "core/servo/mapper.h"
#include "core/servo/servo_rig.h"

namespace facewire::servo {

// What its bus makes of a servo.
struct Actuator {
  float step = 1;  // of its commands, in the servo's unit: 0.25 us, 1 count
  // Tells where the servo is; torque then waits for that. One that does not may still be given a
  // reading: of the pulse that a controller was found to send.
  bool reads_back = false;
};

struct Command {
  float position = 0;    // a whole number of steps; without torque of no meaning to the servo
  bool torque = false;   // in the tick where it comes on, `position` is where the servo is
  bool changed = false;  // position or torque, since the last tick
  Activity activity = Activity::kWaiting;
};

struct Commands {
  std::size_t count = 0;
  std::array<Command, kMaxServos> servos{};  // in the order of ServoRig::servos
};
static_assert(std::is_trivially_copyable_v<Commands>);

// The output side: wishes come in when they come; a tick at the output's own steady rate gives what
// every servo is told. Whatever comes in, a command
//   - lies within its servo's limits, keeps its speed and acceleration (core/servo/axis.h), and
//     keeps every linkage rule (core/servo/linkages.h);
//   - follows, holds, eases or gives up torque by the contract (core/servo/aim.h);
//   - does not move while stopped.
// Motion begins at the position that was read back, or where the bus cannot tell, at the last
// command, at power-on at neutral. It begins as a crawl, for kLeastCrawl and until the servo has
// met its goal.
//
// One thread. Times are of one clock; `now` of the calls should not go back. A `now` that goes back
// by up to kLongestTick counts as the last one, one that goes back further begins a new clock.
class Motion {
 public:
  // After a longer tick the servos have come to rest at their commands: motion goes on from there.
  static constexpr Duration kLongestTick = std::chrono::milliseconds(100);
  static constexpr Duration kLeastCrawl = std::chrono::milliseconds(1000);
  // A position that was read longer ago says nothing.
  static constexpr Duration kFreshReading = std::chrono::milliseconds(1000);
  // Part of its range by which an idle servo may have been moved and still wakes without a crawl.
  static constexpr double kAstray = 0.02;

  // All servos are without torque then, at neutral where their buses cannot tell. `rig` is copied
  // from, not kept; `actuators` in the order of its servos. kOutOfRange: the rig has a flaw
  // (FindFlaw says which), or no whole step of an actuator lies within a servo's limits;
  // kInvalidArgument: actuators missing, or a step that is not positive. Nothing is usable then.
  Result<> Configure(const ServoRig& rig, std::span<const Actuator> actuators) noexcept;

  // New wishes; each is clamped to its servo's limits. NaN and what is missing is no wish: when it
  // lasts, the contract takes its course for that servo. The time from wish to wish is that of
  // `captured`.
  void Take(const Wishes& wishes, Time now) noexcept;

  // One servo by hand. What is not a number, and an index beyond the last servo, changes nothing in
  // these three.
  void SetManual(std::size_t servo, float position, Time now) noexcept;   // repeat it: see Aim
  void SetReading(std::size_t servo, float position, Time now) noexcept;  // was read back
  // 1 = well, less = slower by that factor, 0 = limp until it is above 0 again; clamped to 0..1.
  void SetHealth(std::size_t servo, float part) noexcept;

  // From the next tick on nothing moves, until Release. The commands freeze where they are, because
  // braking would be motion and every servo brakes on its own.
  void Stop() noexcept;
  void Release() noexcept;  // what follows is a crawl
  bool stopped() const noexcept { return stopped_; }

  // One tick, which ends at `now`. Valid until the next one.
  const Commands& Tick(Time now) noexcept;

 private:
  struct Channel {
    Aim aim;
    Actuator actuator;
    Duration limp_after{};
    double range = 0;
    double health = 1;
    double reading = 0;
    std::optional<Duration> read;  // when
    Activity activity = Activity::kWaiting;
    bool torque = false;
    bool idle = false;
    Duration moved{};       // when the command last changed
    Duration crawling{};    // since when
    double crawl_side = 0;  // of the goal: -1, 1; 0: met, or not known
  };

  void Advance(Time now) noexcept;
  double StepSeconds() noexcept;
  void Decide(std::size_t i) noexcept;
  void Run(std::size_t i, double dt_s) noexcept;
  void Engage(std::size_t i, bool crawl) noexcept;
  void Crawl(std::size_t i) noexcept;
  void Drop(std::size_t i) noexcept;
  void WatchCrawl(std::size_t i, double goal) noexcept;
  void Report(std::size_t i) noexcept;

  InlineVector<Channel, kMaxServos> channels_;
  std::array<Axis, kMaxServos> axes_{};
  std::array<double, kMaxServos> goals_{};
  Linkages linkages_;
  Duration stop_torque_{};

  std::optional<Time> last_;
  Duration clock_{};  // since Configure; never goes back
  Duration ticked_{};
  std::optional<Time> captured_;  // of the last wishes
  bool stopped_ = false;
  Duration stopped_at_{};
  Commands commands_;
};

}  // namespace facewire::servo

#endif  // FACEWIRE_CORE_SERVO_MOTION_H_
