#ifndef FACEWIRE_APP_STATUS_REPORT_H_
#define FACEWIRE_APP_STATUS_REPORT_H_

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "app/animatronic/bus_config.h"
#include "app/host_line.h"
#include "app/service.h"
#include "core/base/capacity.h"
#include "core/servo/servo_rig.h"

namespace facewire::app {

// What `facewire status` shows: all there is to know about a running service.
struct StatusReport {
  const Service& service;
  const HostLine& line;
  std::string_view camera_address;
  std::string_view line_address;  // empty: none
  std::string_view state_folder;
  std::string_view storage_problem;  // why nothing can be kept there; empty: it can
  std::string_view stop_problem;  // why a restart may forget an emergency stop; empty: it does not
  Duration searching_after{};     // zero: not yet
  std::span<const ServoBusConfig> buses;
  const servo::ServoRig* servos = nullptr;  // null only without buses
};

// Longer than any report, with addresses of ordinary length; a longer one is cut, and no JSON.
inline constexpr std::size_t kMaxReportBytes = 4096 + kMaxServos * 400 + kMaxBuses * 512;

// One JSON object on one line (its members: app/README.md). Allocates nothing.
std::array<char, kMaxReportBytes> ToJson(const StatusReport& report) noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_STATUS_REPORT_H_
