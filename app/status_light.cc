#include "app/status_light.h"

#include <array>
#include <cstddef>
#include <span>

namespace facewire::app {
namespace {

using std::chrono::milliseconds;

// Milliseconds lit, dark, lit, dark, ...; then again from the beginning.
constexpr std::array kOn = {1000};
constexpr std::array kEven = {250, 250};
constexpr std::array kSlow = {1000, 1000};
constexpr std::array kGaps = {800, 200};
constexpr std::array kRare = {100, 3900};
constexpr std::array kTwice = {150, 150, 150, 1050};
constexpr std::array kThrice = {150, 150, 150, 150, 150, 750};
constexpr std::array kFast = {100, 100};

std::span<const int> PatternOf(ServiceState state, bool calibrating) noexcept {
  // A stop or a fault is more urgent than that a calibration is about to fail of it.
  if (state == ServiceState::kStopped) return kTwice;
  if (state == ServiceState::kFault) return kFast;
  if (calibrating) return kThrice;
  switch (state) {
    case ServiceState::kStarting:
      return kEven;
    case ServiceState::kSearching:
      return kSlow;
    case ServiceState::kTracking:
      return kOn;
    case ServiceState::kHolding:
    case ServiceState::kEasing:
      return kGaps;
    case ServiceState::kResting:
      return kRare;
    default:
      return kFast;
  }
}

}  // namespace

bool StatusLight(ServiceState state, bool calibrating, Duration elapsed) noexcept {
  const std::span<const int> pattern = PatternOf(state, calibrating);
  Duration period{};
  for (const int part : pattern) period += milliseconds(part);
  Duration at = elapsed % period;
  std::size_t part = 0;
  while (at >= milliseconds(pattern[part])) at -= milliseconds(pattern[part++]);
  return part % 2 == 0;
}

}  // namespace facewire::app
