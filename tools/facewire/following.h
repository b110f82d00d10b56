#ifndef FACEWIRE_TOOLS_FACEWIRE_FOLLOWING_H_
#define FACEWIRE_TOOLS_FACEWIRE_FOLLOWING_H_

#include <limits>
#include <string>
#include <vector>

#include "core/servo/servo_rig.h"
#include "tools/sheet/traces.h"

namespace facewire::tools {

// What one servo on a bus did, as a simulated bus writes it (tests/sim/README.md): every row holds
// until the next. Positions are in the servo's own unit; times are those of the machine's monotonic
// clock, as poses on the wire have them too.
struct ServoRow {
  double t_s = 0;
  bool torque_on = false;
  double goal = 0;       // what the bus was asked for
  double commanded = 0;  // what it made of it: the pulse, or the goal after the servo's own limits
  double position = 0;   // where the servo truly is
};
// The rows of the servo `index`, from 0, in a CSV file. Throws BadInput.
std::vector<ServoRow> ReadServoRows(const std::string& path, int index);

// How one curve follows another: the delay, up to kLongestLag, that explains it best (least
// squares), and what is left between the two when that delay is taken out.
struct Following {
  double lag_ms = std::numeric_limits<double>::quiet_NaN();  // NaN: the other one did not move
  double rms = 0;
  double largest = 0;
};
inline constexpr double kLongestLagS = 0.5;

// A servo from its parameter to its shaft, in its own unit, from kSettledS after its command, and
// what the servo makes of it, first met the parameter (until then both crawl) until the torque went
// or the poses ended.
struct ServoFollowing {
  TimeSpan span{};
  double moved = 0;    // of the parameter, from its least to its most
  Following command;   // behind the parameter
  Following position;  // behind the command
  // The largest difference between goal and commanded, kRestedS after the goal last changed: what
  // the bus cannot resolve.
  double unresolved = 0;
  double beyond_limits = 0;  // how far a command was outside min to max, ever
  bool torque_at_end = false;
  TimeSpan liveliest{};  // kCloseUpS of the span in which the parameter moves most
};
inline constexpr double kSettledS = 1.5;
inline constexpr double kRestedS = 0.1;
inline constexpr double kCloseUpS = 2;

// `parameter`: the servo's position as the poses want it. Throws BadInput when the span is shorter
// than a second.
ServoFollowing Measure(const servo::Servo& servo, const Curve& parameter,
                       const std::vector<ServoRow>& rows);

// Why this is no following, in words; "" when it is one: commands stay within the limits, command
// and position each come within a quarter of a second and then are off (rms) by no more than a
// tenth of the motion and two dead bands, at rest the bus is at most `step` off, and at the end
// there is no torque.
std::string WhyNot(const servo::Servo& servo, const ServoFollowing& following, double step);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_FOLLOWING_H_
