#ifndef FACEWIRE_TESTS_SIM_TRACE_H_
#define FACEWIRE_TESTS_SIM_TRACE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/time.h"

namespace facewire::sim {

// What a simulated bus records of what its servos did. `detail` of an event is named beside each.
enum class EventKind : std::uint8_t {
  kEepromWrite,    // address; kept when the power goes
  kEepromTry,      // address; written while locked: refused, or lost when the power goes
  kFactoryReset,   // option
  kReboot,         // 0
  kTorqueOn,       // 0; the motor is driven, or no longer: whatever the cause, on every bus
  kTorqueOff,      // 0
  kError,          // error bits: Maestro's register, Dynamixel's hardware status, Feetech's status
  kOverload,       // 0
  kOverheated,     // degrees Celsius
  kVoltage,        // tenths of a volt
  kOvercurrent,    // milliamperes
  kBurnt,          // degrees Celsius
  kBrownOut,       // tenths of a volt
  kWatchdog,       // its time in ms: Dynamixel's bus watchdog, Maestro's serial timeout
  kCollision,      // 0; host and servo, or two servos, talked at once
  kDamagedPacket,  // 0; wrong checksum
  kProtocol,       // the byte or code that made no sense
  kOutsideLimits,  // the commanded position, beyond the servo's own limits
  kFault,          // number of the injected fault's kind
  kFaultEnds,      // number of the injected fault's kind
};
constexpr std::size_t kEventKinds = 20;
const char* Name(EventKind kind);

constexpr int kWholeBus = -1;

struct Event {
  Time at;
  int servo;  // index from 0, or kWholeBus
  EventKind kind;
  int detail;
};

// One servo at one instant. Positions and speeds are in the servo's own unit (us of pulse width, or
// counts; per second). `goal` is what the host last asked for; `commanded` is what the servo is
// told to be at right now: the pulse that is on the wire, or the goal after its own speed and
// acceleration limits. Both say nothing while the torque is off.
struct Sample {
  Time at{};
  int servo = kWholeBus;
  bool torque_on = false;
  float goal = 0;
  float commanded = 0;
  float position = 0;  // true, of the output shaft
  float speed = 0;
  float current_A = 0;
  float temperature_C = 0;
  float torque_Nm = 0;
  float voltage_V = 0;
};

// Says of a sample whether it differs visibly from the last one of its servo of which it said so: a
// new command, torque switched, position by half a unit, temperature by half a degree.
class ChangeFilter {
 public:
  bool operator()(const Sample& sample);

 private:
  std::vector<Sample> last_;  // by servo; `servo` is kWholeBus before the first
};

class Trace {
 public:
  enum class Keep { kNothing, kChanges, kEveryMillisecond };

  // Which samples samples() keeps; events are always kept. Nothing unless asked.
  void KeepSamples(Keep keep) { keep_ = keep; }
  // Called with every sample (one per servo and millisecond) and every event as they happen.
  void OnSample(std::function<void(const Sample&)> callback) { on_sample_ = std::move(callback); }
  void OnEvent(std::function<void(const Event&)> callback) { on_event_ = std::move(callback); }

  void Add(const Sample& sample);
  void Add(const Event& event);

  const std::vector<Sample>& samples() const { return samples_; }
  const std::vector<Event>& events() const { return events_; }
  // How often `kind` happened, to one servo or (any) to all of them.
  static constexpr int kAny = -2;
  std::size_t Count(EventKind kind, int servo = kAny) const;

 private:
  Keep keep_ = Keep::kNothing;
  std::function<void(const Sample&)> on_sample_;
  std::function<void(const Event&)> on_event_;
  std::vector<Sample> samples_;
  std::vector<Event> events_;
  ChangeFilter is_change_;
};

// A file of both: rows of samples have no event, rows of events no sample.
std::string CsvHeader();
std::string CsvLine(const Sample& sample);
std::string CsvLine(const Event& event);

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_TRACE_H_
