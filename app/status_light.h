#ifndef FACEWIRE_APP_STATUS_LIGHT_H_
#define FACEWIRE_APP_STATUS_LIGHT_H_

#include <chrono>

#include "core/base/time.h"
#include "core/service_state.h"

namespace facewire::app {

// No part of a pattern is shorter: two ticks at the slowest rate of the service, so no flash is
// lost between ticks.
inline constexpr Duration kShortestFlash = std::chrono::milliseconds(100);

// Whether the status LED is lit when the service has been in `state` for `elapsed` (not negative).
// What needs to be told apart differs within four seconds (holding and easing look alike); the
// table of the patterns is in app/README.md. `calibrating`: somebody has asked for a calibration,
// and it is running.
bool StatusLight(ServiceState state, bool calibrating, Duration elapsed) noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_STATUS_LIGHT_H_
