#ifndef FACEWIRE_APP_SERVO_RIG_FILE_H_
#define FACEWIRE_APP_SERVO_RIG_FILE_H_

#include <filesystem>

#include "core/rig/rig.h"
#include "core/servo/servo_rig.h"

namespace facewire::app {

// Reads the servos of a rig ([servos], [[servo]] and [[linkage]] of rig.toml, app/README.md); none,
// when the file has none. `rig` is what LoadRig made of the same file. Throws BadInput with every
// problem on a line of its own, "FILE:LINE:COLUMN: what is wrong; what would be right". What it
// returns has no flaw (servo::FindFlaw). Whether a bus exists is left to the reader of buses.
servo::ServoRig LoadServoRig(const std::filesystem::path& file, const Rig& rig);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_SERVO_RIG_FILE_H_
