#ifndef FACEWIRE_TESTS_SIM_FAULTS_H_
#define FACEWIRE_TESTS_SIM_FAULTS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time.h"

namespace facewire::sim {

// What goes wrong on the line all the time, each by chance. The same in both directions.
struct LineFaults {
  double lose = 0;       // of a byte
  double flip = 0;       // of one bit of a byte
  double duplicate = 0;  // of a byte
  double late = 0;       // of a reply: it comes up to late_ms later
  double late_ms = 20;
  double noise_per_s = 0;  // bytes that nobody sent, on a quiet line
};

// What happens to one servo for a while.
enum class FaultKind : std::uint8_t {
  kVanish,    // unplugged: no power, no answer; comes back as after power-on
  kMute,      // hears and answers nothing, but does what it was told
  kBrownOut,  // its supply dips once: starts anew
  kJam,       // its mechanism does not go past `value` (servo's own unit)
  kHot,       // is suddenly `value` degrees Celsius warm; cools by its own means
  kJump,      // its sensor is off by `value` (servo's own unit)
};
constexpr std::size_t kFaultKinds = 6;
constexpr std::array<const char*, kFaultKinds> kFaultNames = {"vanish", "mute", "brownout",
                                                              "jam",    "hot",  "jump"};

struct Fault {
  FaultKind kind = FaultKind::kVanish;
  std::size_t servo = 0;  // index from 0
  Duration at{};          // since the bus was first advanced
  Duration lasts{};       // zero: for good (kBrownOut and kHot happen once)
  double value = 0;
};

struct FaultPlan {
  LineFaults line;
  std::vector<Fault> faults;
};

// Adds what `text` says to `plan`: a rate as NAME=NUMBER (lose, flip, duplicate, late, late-ms,
// noise), or a fault as NAME:SERVO@START[+LASTS][=VALUE], times in seconds, servos from 0:
// "jam:3@2.5+1=1600". Otherwise the one-line reason why not.
std::optional<std::string> AddFault(std::string_view text, FaultPlan& plan);

// `per_minute` faults of any kind on any of `servos` servos in `total`, always the same for a seed.
// A servo's own unit goes from `low` to `high`.
std::vector<Fault> RandomFaults(std::uint64_t seed, std::size_t servos, Duration total,
                                double per_minute, double low, double high);

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_FAULTS_H_
