#include "tests/sim/trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace facewire::sim {

const char* Name(EventKind kind) {
  constexpr std::array<const char*, kEventKinds> kNames = {
      "eeprom-write", "eeprom-try", "factory-reset", "reboot",     "torque-on",
      "torque-off",   "error",      "overload",      "overheated", "voltage",
      "overcurrent",  "burnt",      "brown-out",     "watchdog",   "collision",
      "damaged",      "protocol",   "outside",       "fault",      "fault-ends"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool ChangeFilter::operator()(const Sample& sample) {
  const auto index = static_cast<std::size_t>(sample.servo);
  if (last_.size() <= index) last_.resize(index + 1);
  Sample& last = last_[index];
  const bool change =
      last.servo == kWholeBus ||
      (sample.torque_on && (sample.goal != last.goal || sample.commanded != last.commanded)) ||
      sample.torque_on != last.torque_on || std::abs(sample.position - last.position) >= 0.5F ||
      std::abs(sample.temperature_C - last.temperature_C) >= 0.5F;
  if (change) last = sample;
  return change;
}

void Trace::Add(const Sample& sample) {
  if (on_sample_) on_sample_(sample);
  if (keep_ == Keep::kEveryMillisecond || (keep_ == Keep::kChanges && is_change_(sample))) {
    samples_.push_back(sample);
  }
}

void Trace::Add(const Event& event) {
  if (on_event_) on_event_(event);
  events_.push_back(event);
}

std::size_t Trace::Count(EventKind kind, int servo) const {
  return static_cast<std::size_t>(std::count_if(
      events_.begin(), events_.end(),
      [&](const Event& e) { return e.kind == kind && (servo == kAny || e.servo == servo); }));
}

std::string CsvHeader() {
  return "t_us,servo,event,detail,torque_on,goal,commanded,position,speed,current_A,temperature_C,"
         "torque_Nm,voltage_V\n";
}

std::string CsvLine(const Sample& s) {
  std::array<char, 200> line;
  std::snprintf(line.data(), line.size(), "%lld,%d,,,%d,%.2f,%.2f,%.2f,%.1f,%.3f,%.1f,%.4f,%.2f\n",
                static_cast<long long>(s.at.time_since_epoch().count()), s.servo,
                s.torque_on ? 1 : 0, s.goal, s.commanded, s.position, s.speed, s.current_A,
                s.temperature_C, s.torque_Nm, s.voltage_V);
  return line.data();
}

std::string CsvLine(const Event& e) {
  std::array<char, 100> line;
  std::snprintf(line.data(), line.size(), "%lld,%d,%s,%d,,,,,,,,,\n",
                static_cast<long long>(e.at.time_since_epoch().count()), e.servo, Name(e.kind),
                e.detail);
  return line.data();
}

}  // namespace facewire::sim
