#ifndef FACEWIRE_TOOLS_FACEWIRE_DOCTOR_GPIO_H_
#define FACEWIRE_TOOLS_FACEWIRE_DOCTOR_GPIO_H_

#include <vector>

#include "app/config.h"
#include "hal/gpiod/library.h"
#include "tools/facewire/finding.h"

namespace facewire::tools {

// The GPIO chips of this machine, and what keeps the lines of a configuration (null: there is none)
// from being used. Takes no line: a running service keeps its own.
std::vector<Finding> CheckGpio(const app::GpioConfig* gpio, hal::gpiod::Library& library);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_DOCTOR_GPIO_H_
