#include "core/bus/servo_bus.h"

namespace facewire::bus {

void NoteFinding(Findings& findings, const Finding& finding, bool fine) noexcept {
  for (std::size_t i = 0; i < findings.size(); ++i) {
    if (findings[i].servo != finding.servo || findings[i].setting != finding.setting) continue;
    findings[i] = finding;
    if (!fine) return;
    findings[i] = findings[findings.size() - 1];
    (void)findings.try_resize(findings.size() - 1);
    return;
  }
  if (!fine) (void)findings.try_push(finding);
}

const char* Name(ServoState state) noexcept {
  switch (state) {
    case ServoState::kAbsent:
      return "absent";
    case ServoState::kChecking:
      return "checking";
    case ServoState::kRefused:
      return "refused";
    case ServoState::kLimp:
      return "limp";
    case ServoState::kArming:
      return "arming";
    case ServoState::kOn:
      return "on";
  }
  return "unknown";
}

const char* Name(BusState state) noexcept {
  switch (state) {
    case BusState::kStarting:
      return "starting";
    case BusState::kChecking:
      return "checking settings";
    case BusState::kRunning:
      return "running";
    case BusState::kFault:
      return "fault";
  }
  return "unknown";
}

const char* Name(BusFault fault) noexcept {
  switch (fault) {
    case BusFault::kNone:
      return "none";
    case BusFault::kNotConfigured:
      return "not configured";
    case BusFault::kNobodyAnswers:
      return "nobody answers";
    case BusFault::kEcho:
      return "the line echoes";
    case BusFault::kSettings:
      return "settings";
  }
  return "unknown";
}

const char* Name(Setting setting) noexcept {
  switch (setting) {
    case Setting::kOperatingMode:
      return "operating mode";
    case Setting::kMinPosition:
      return "min position limit";
    case Setting::kMaxPosition:
      return "max position limit";
    case Setting::kShutdown:
      return "shutdown conditions";
    case Setting::kReturnDelay:
      return "return delay";
    case Setting::kProfileUnit:
      return "profile unit";
    case Setting::kLock:
      return "EEPROM lock";
    case Setting::kBaudRate:
      return "baud rate";
    case Setting::kPulseRange:
      return "pulse range";
    case Setting::kSerialErrors:
      return "serial errors";
    case Setting::kOutputs:
      return "outputs";
  }
  return "unknown";
}

}  // namespace facewire::bus
