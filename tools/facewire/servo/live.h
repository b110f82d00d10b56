#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_LIVE_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_LIVE_H_

#include <cstddef>
#include <functional>

#include "core/base/time.h"
#include "hal/clock.h"
#include "tools/facewire/servo/installation.h"

namespace facewire::tools {

// Has the running service hold a servo at `position` by hand for `longest`, or until `stop` says
// so; the performer keeps all others, and has this one again afterwards. Throws BadInput (no such
// service), Failure (it refuses, or is lost).
void HoldLive(const Installation& all, std::size_t servo, float position, Duration longest,
              hal::Clock& clock, const std::function<bool()>& stop);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_LIVE_H_
