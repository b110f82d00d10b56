#include "core/bus/guard.h"

#include <algorithm>
#include <cmath>

namespace facewire::bus {
namespace {

// 1 up to `from`, falling to 0 at `to`.
float Fall(float value, float from, float to) noexcept {
  if (value <= from) return 1;
  if (value >= to) return 0;
  return (to - value) / (to - from);
}

}  // namespace

const char* Name(HardwareFault fault) noexcept {
  switch (fault) {
    case HardwareFault::kVoltage:
      return "voltage";
    case HardwareFault::kHeat:
      return "heat";
    case HardwareFault::kEncoder:
      return "encoder";
    case HardwareFault::kShock:
      return "electrical shock";
    case HardwareFault::kOverload:
      return "overload";
    case HardwareFault::kCurrent:
      return "current";
  }
  return "unknown";
}

const char* Name(Reason reason) noexcept {
  switch (reason) {
    case Reason::kNone:
      return "none";
    case Reason::kHeat:
      return "heat";
    case Reason::kLoad:
      return "load";
    case Reason::kHardware:
      return "hardware fault";
    case Reason::kAbsent:
      return "does not answer";
    case Reason::kStarting:
      return "is being checked";
    case Reason::kSettings:
      return "settings";
  }
  return "unknown";
}

void Guard::LetGo(Time now, Reason reason) noexcept {
  factor_ = 0;
  reason_ = reason;
  let_go_ = now;
}

void Guard::Update(Time now, std::optional<float> temperature_c, std::optional<float> load,
                   HardwareFaults faults) noexcept {
  if (temperature_c && std::isfinite(*temperature_c)) temperature_c_ = *temperature_c;
  if (load && std::isfinite(*load)) {
    // The first one counts for nothing, one after a long silence for a second.
    const float passed_s =
        load_at_ ? std::clamp(Seconds(Between(*load_at_, now)), 0.0F, 1.0F) : 0.0F;
    load_at_ = now;
    const float time_s = std::max(Seconds(config_.load_time), 1e-3F);
    strain_ += (std::min(std::abs(*load), 1.0F) - strain_) * (1 - std::exp(-passed_s / time_s));
  }

  if ((faults & ~unsigned{Bit(HardwareFault::kVoltage)}) != 0) return LetGo(now, Reason::kHardware);
  if (temperature_c_ >= config_.hot_c) return LetGo(now, Reason::kHeat);
  if (strain_ >= config_.max_load) return LetGo(now, Reason::kLoad);
  if (let_go_) {
    const bool rested = Between(*let_go_, now) >= config_.rest;
    const bool cool = reason_ != Reason::kHeat || temperature_c_ <= config_.cool_c;
    const bool eased = reason_ != Reason::kLoad || strain_ < config_.high_load;
    if (!rested || !cool || !eased) return;
    let_go_.reset();
  }
  const float heat = Fall(temperature_c_, config_.warm_c, config_.hot_c);
  const float strain = Fall(strain_, config_.high_load, config_.max_load);
  factor_ = std::max(std::min(heat, strain), kSlowest);
  reason_ = factor_ == 1 ? Reason::kNone : heat <= strain ? Reason::kHeat : Reason::kLoad;
}

}  // namespace facewire::bus
