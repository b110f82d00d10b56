#ifndef FACEWIRE_CORE_BUS_GUARD_H_
#define FACEWIRE_CORE_BUS_GUARD_H_

#include <chrono>
#include <cstdint>
#include <optional>

#include "core/base/time.h"

namespace facewire::bus {

// What a servo can report about itself, whatever its bus calls it.
enum class HardwareFault : std::uint8_t {
  kVoltage = 1U << 0U,
  kHeat = 1U << 1U,
  kEncoder = 1U << 2U,
  kShock = 1U << 3U,  // electrical
  kOverload = 1U << 4U,
  kCurrent = 1U << 5U,
};
using HardwareFaults = std::uint8_t;  // bits of HardwareFault
const char* Name(HardwareFault fault) noexcept;
constexpr HardwareFaults Bit(HardwareFault fault) noexcept {
  return static_cast<HardwareFaults>(fault);
}

// Why a servo may do less than it could.
enum class Reason : std::uint8_t {
  kNone,
  kHeat,
  kLoad,
  kHardware,  // HardwareFaults says which
  kAbsent,
  kStarting,  // is being looked at
  kSettings,
};
const char* Name(Reason reason) noexcept;

struct GuardConfig {
  float warm_c = 55;  // from here on it is slowed down
  float hot_c = 65;   // here it is let go
  float cool_c = 50;  // and from here on it may move again
  // |load| averaged over load_time: slowed down from the first, let go at the second.
  float high_load = 0.6F;
  float max_load = 0.9F;
  Duration load_time = std::chrono::seconds(3);
  Duration rest = std::chrono::seconds(5);  // how long it is let go at least, heat and faults too
};

// Keeps one servo from burning: slows it down, then lets it go, until it has recovered.
class Guard {
 public:
  Guard() noexcept = default;
  explicit Guard(const GuardConfig& config) noexcept : config_(config) {}

  // What was measured at `now`; what the bus does not tell, or is no number, changes nothing.
  // Voltage faults alone let nobody go: they say more about the supply, and a sag would
  // otherwise drop a head.
  void Update(Time now, std::optional<float> temperature_c, std::optional<float> load,
              HardwareFaults faults) noexcept;
  // 1 full speed .. 0 let go.
  float factor() const noexcept { return factor_; }
  Reason reason() const noexcept { return reason_; }

 private:
  // The least factor that still moves; below it a servo would only look broken.
  static constexpr float kSlowest = 0.2F;

  void LetGo(Time now, Reason reason) noexcept;

  GuardConfig config_;
  float temperature_c_ = 0;
  float strain_ = 0;  // |load|, averaged
  std::optional<Time> load_at_;
  std::optional<Time> let_go_;
  float factor_ = 1;
  Reason reason_ = Reason::kNone;
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_GUARD_H_
