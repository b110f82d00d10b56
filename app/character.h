#ifndef FACEWIRE_APP_CHARACTER_H_
#define FACEWIRE_APP_CHARACTER_H_

#include <cstdint>

#include "core/retarget/retargeter.h"
#include "core/rig/rig.h"
#include "core/servo/mapper.h"
#include "core/servo/servo_rig.h"

namespace facewire::app {

// A rig, ready to be driven. The service runs one while a reload builds another.
struct Character {
  Rig rig;
  std::uint32_t rig_id = 0;         // wire::RigId(rig)
  retarget::Retargeter retargeter;  // configured for the rig
  servo::ServoRig servos;
  servo::Mapper mapper;  // from the rig to the servos that are driven
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CHARACTER_H_
