#ifndef FACEWIRE_APP_ANIMATRONIC_SERVO_WATCH_H_
#define FACEWIRE_APP_ANIMATRONIC_SERVO_WATCH_H_

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "app/animatronic/servo_report.h"
#include "app/journal.h"
#include "core/base/capacity.h"
#include "core/base/time.h"
#include "core/servo/servo_rig.h"

namespace facewire::app {

// Tells the journal what has changed about buses and servos, once for each change: who is lost, who
// is back, who is hot, who was refused and what would mend it (`facewire servo list` tells of
// settings that are no danger, too). Look allocates nothing.
class ServoWatch {
 public:
  // What a servo does must last for so long before it is told: one that starts anew, or a supply
  // that sags for a moment, is counted and no news.
  static constexpr Duration kSettled = std::chrono::seconds(2);

  // The rig is borrowed.
  ServoWatch(Journal& journal, const servo::ServoRig& rig, std::vector<ServoBusConfig> buses);

  // `powered`: false while a line of the board keeps the servos without power, and their silence is
  // no news.
  void Look(const ServoReport& report, bool powered, Time now) noexcept;

 private:
  enum class BusNews : std::uint8_t { kNone, kLost, kStuck, kNobody, kEcho };
  enum class ServoNews : std::uint8_t {
    kNone,
    kAbsent,
    kRefused,
    kSlowedByHeat,
    kSlowedByLoad,
    kLetGoByHeat,
    kLetGoByLoad,
    kHardware,
  };
  struct Told {
    ServoNews told = ServoNews::kNone;
    ServoNews seen = ServoNews::kNone;
    Time since{};                // it was seen
    std::uint16_t settings = 0;  // bits of bus::Setting that were told
  };

  static BusNews NewsOf(const ServoReport::Bus& bus) noexcept;
  static ServoNews NewsOf(const bus::ServoFeedback& feedback) noexcept;
  void TellBus(std::size_t bus, BusNews news) noexcept;
  void TellServo(std::size_t servo, ServoNews news, const ServoReport& report) noexcept;
  void TellFindings(const ServoReport& report) noexcept;
  const ServoBusConfig& BusOf(std::size_t servo) const noexcept;

  Journal& journal_;
  const servo::ServoRig& rig_;
  std::vector<ServoBusConfig> buses_;
  std::array<BusNews, kMaxBuses> told_buses_{};
  std::array<Told, kMaxServos> servos_{};
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_SERVO_WATCH_H_
