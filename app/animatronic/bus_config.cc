#include "app/animatronic/bus_config.h"

namespace facewire::app {

const char* Name(BusKind kind) noexcept {
  switch (kind) {
    case BusKind::kMaestro:
      return "maestro";
    case BusKind::kDynamixel:
      return "dynamixel";
    case BusKind::kFeetech:
      return "feetech";
    case BusKind::kReceiver:
      return "receiver";
  }
  return "unknown";
}

int DefaultBaud(BusKind kind) noexcept {
  switch (kind) {
    case BusKind::kDynamixel:
      return 57'600;
    case BusKind::kFeetech:
      return 1'000'000;
    case BusKind::kMaestro:
    case BusKind::kReceiver:
      break;
  }
  return 115'200;
}

int DefaultRate(BusKind kind) noexcept {
  return kind == BusKind::kDynamixel || kind == BusKind::kFeetech ? 100 : 50;
}

}  // namespace facewire::app
