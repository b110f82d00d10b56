#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_PROBE_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_PROBE_H_

#include <functional>
#include <optional>
#include <span>

#include "tools/facewire/servo/found_bus.h"
#include "tools/facewire/servo/line.h"

namespace facewire::tools {

// What is at the other end of a line that is open at some rate, if it speaks this protocol. Only
// questions are sent: nothing moves, nothing is set. The result has neither port nor rate. Throw
// Failure when the port is gone.

// Sends nothing: a receiver tells how it is once a second, and as soon as it has started; one that
// opening its port has reset takes two seconds for that.
std::optional<FoundBus> ProbeReceiver(Line& line);
// Ends what it asks with a CRC only for a board that was silent without one: to another board a
// lone byte would be an error, which sends its servos to their homes.
std::optional<FoundBus> ProbeMaestro(Line& line);
std::optional<FoundBus> ProbeDynamixel(Line& line);
// Asks ids 0 to 20, or every id, which takes 5 s.
std::optional<FoundBus> ProbeFeetech(Line& line, bool all_ids);

// The rates at which such buses are found, the usual one first.
std::span<const int> UsualRates(Protocol protocol);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_PROBE_H_
