#ifndef FACEWIRE_CORE_SERVO_SERVO_RIG_H_
#define FACEWIRE_CORE_SERVO_SERVO_RIG_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/name.h"
#include "core/base/time.h"
#include "core/rig/response.h"
#include "core/rig/rig.h"

// The servos of a character as data: what a builder writes into rig.toml. Positions are in each
// servo's own unit: microseconds of pulse width, or counts of a servo that has a bus.
namespace facewire::servo {

// One part of the sum that moves a servo: gain * value of a channel of the rig ("jaw.pitch",
// "eyeBlinkLeft"), in that channel's unit.
struct Source {
  ShortName channel;
  float gain = 1;
};

struct Servo {
  ShortName name;
  ShortName bus;        // of a [[bus]] of facewire.toml
  std::uint8_t id = 0;  // of the channel of a controller, or of the servo on its bus
  // wished position = map(offset + sum of the sources). Without a source it moves by hand only.
  InlineVector<Source, kMaxDrives> sources;
  float offset = 0;
  // From the sum to the servo's unit. `in` rises; `out` rises all the way or falls all the way,
  // which is the servo's direction. Two points are a straight line with stops, more a smooth curve
  // (core/rig/response.h).
  InlineVector<CurvePoint, kMaxCurvePoints> map;
  // No command is ever outside min to max; min <= neutral <= max. In the servo's unit, as all
  // below.
  float min = 0;
  float max = 0;
  float neutral = 0;
  // What the actuator does not show: it stays for a change that is no larger than dead_band, and
  // after a turn its output stays until the gear has gone through `backlash`. Wishes that ask for
  // less are not sent.
  float dead_band = 0;
  float backlash = 0;
  float max_speed_per_s = 0;          // > 0: no servo is without a limit
  float max_acceleration_per_s2 = 0;  // 0 = unlimited
  // Of every motion that begins where nobody knows what to expect: at power-on, after a stop, after
  // a release. > 0, at most max_speed_per_s; the acceleration is less by the same factor.
  float crawl_speed_per_s = 0;
  Duration limp_after{};  // torque off when it has not had to move for so long; 0 = never

  // map(offset + sum), not limited to min to max; falls or rises with the sum. NaN gives NaN.
  double PositionOf(double sum) const noexcept;
};

enum class Relation : std::uint8_t { kAtLeast, kAtMost };

// A rule between two servos that could collide; it holds for the commands of every tick:
//     position(yields)  >= or <=  gain * position(other) + offset
// The one that yields makes way for where the other wants to go; the other waits until it has.
struct Linkage {
  ShortName name;
  std::uint8_t yields = 0;  // index into ServoRig::servos
  std::uint8_t other = 0;
  Relation relation = Relation::kAtLeast;
  float gain = 1;
  float offset = 0;  // in the unit of the servo that yields
};

// What happens when whoever makes the wishes falls silent. Counted from the last wish that was
// usable; each time follows the one before it.
struct Contract {
  Duration fresh = std::chrono::milliseconds(200);  // so late a wish may be
  Duration hold = std::chrono::milliseconds(400);   // then the last one is kept
  Duration ease = std::chrono::milliseconds(1500);  // from there to neutral
  Duration limp = std::chrono::milliseconds(5000);  // at neutral with torque, then torque off
  // An emergency stop freezes the commands at once. For so long the servos keep their torque, for a
  // head that would fall; 0: limp in the same tick, as on every other host.
  Duration stop_torque{};
};

// How the wishes, which come at the camera's rate, become goals at the bus's rate.
struct Following {
  // How strongly what trembles is averaged, in bands of the servo (the larger of dead band and
  // backlash): 0 = not at all.
  float calm = 5;
  // Motion is carried on for so long ahead of its last wish: 0 = none, the wish is reached when the
  // next one is due.
  Duration lead{};
};

struct ServoRig {
  InlineVector<Servo, kMaxServos> servos;
  InlineVector<Linkage, kMaxLinkages> linkages;
  Contract contract;
  Following following;

  std::optional<std::size_t> Find(std::string_view servo) const noexcept;
};

// What is wrong with a ServoRig, and where.
struct Flaw {
  enum class Part : std::uint8_t {
    kName,      // empty, or a second one
    kAddress,   // no bus, or a second servo with this bus and id
    kSource,    // `item`: its index; the rig has no such channel, or the gain is not finite
    kMap,       // fewer than two points, out of order, not finite; or the offset
    kRange,     // min < max and min <= neutral <= max does not hold
    kBand,      // dead band or backlash: negative, not finite, or as wide as the range
    kMotion,    // speed, acceleration, crawl or idle time
    kLinkage,   // `item`: its index; no such servo, not finite, or broken at neutral
    kContract,  // a negative time
    kFollowing,
  };
  Part part = Part::kName;
  std::size_t servo = 0;  // index; of a linkage the one that yields
  std::size_t item = 0;
};

// The first flaw, if any. The first form checks all but the names of the sources.
std::optional<Flaw> FindFlaw(const ServoRig& servos) noexcept;
std::optional<Flaw> FindFlaw(const ServoRig& servos, const Rig& rig) noexcept;

}  // namespace facewire::servo

#endif  // FACEWIRE_CORE_SERVO_SERVO_RIG_H_
