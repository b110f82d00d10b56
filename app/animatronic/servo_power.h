#ifndef FACEWIRE_APP_ANIMATRONIC_SERVO_POWER_H_
#define FACEWIRE_APP_ANIMATRONIC_SERVO_POWER_H_

#include <chrono>
#include <optional>

#include "app/animatronic/servo_report.h"
#include "core/base/time.h"
#include "core/servo/servo_rig.h"

namespace facewire::app {

// Whether servos on buses may have power, where the board can switch it: the last means of the
// rig's contract. It ends what nobody can tell to let go.
class ServoPower {
 public:
  // A report that is older says nothing about the present.
  static constexpr Duration kFreshReport = std::chrono::seconds(1);
  // Power goes off for so long that capacitors are empty; servos come back limp.
  static constexpr Duration kCut = std::chrono::seconds(2);

  // How long after the last word a servo's torque must be off.
  explicit ServoPower(const servo::Contract& contract) noexcept
      : patience_(contract.fresh + contract.hold + contract.ease + contract.limp) {}

  // Once a tick. No: nobody reports, a port has been lost for longer than the contract allows, or
  // a servo was stranded for so long and its power is being cut.
  bool Allowed(const ServoReport& report, Time now) noexcept;

 private:
  Duration patience_;
  std::optional<Time> cut_until_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_SERVO_POWER_H_
