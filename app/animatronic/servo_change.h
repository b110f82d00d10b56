#ifndef FACEWIRE_APP_ANIMATRONIC_SERVO_CHANGE_H_
#define FACEWIRE_APP_ANIMATRONIC_SERVO_CHANGE_H_

#include "core/servo/servo_rig.h"

namespace facewire::app {

// Whether two rigs have the same servos but for what moves them: sources, offset and map, which may
// be changed while the servos move. All else their drivers and their motion were built from.
bool SameButForMapping(const servo::ServoRig& a, const servo::ServoRig& b) noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_SERVO_CHANGE_H_
