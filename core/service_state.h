#ifndef FACEWIRE_CORE_SERVICE_STATE_H_
#define FACEWIRE_CORE_SERVICE_STATE_H_

#include <cstdint>

namespace facewire {

// What the service is doing. The numbers are those of the wire (core/wire/README.md): append only.
enum class ServiceState : std::uint8_t {
  kStarting = 0,   // building, ramping from the servos' position to neutral
  kSearching = 1,  // no face; the rig is neutral
  kTracking = 2,   // the rig follows a face
  kHolding = 3,    // the face was just lost: the last pose is kept for a short while
  kEasing = 4,     // on the way to neutral
  kResting = 5,    // neutral for long enough: servos may go limp; still looking for a face
  kStopped = 6,    // emergency stop, latched until it is released
  kFault = 7,      // something needs a person (camera or line gone); neutral where possible
};

const char* Name(ServiceState state) noexcept;  // core/state: "tracking" and so on

}  // namespace facewire

#endif  // FACEWIRE_CORE_SERVICE_STATE_H_
