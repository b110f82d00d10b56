#ifndef FACEWIRE_CORE_BUS_SERVO_BUS_H_
#define FACEWIRE_CORE_BUS_SERVO_BUS_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/bus/guard.h"

// What every servo bus can do, whatever its protocol. A driver owns no port and knows no clock: it
// turns commands into bytes and bytes into feedback. README.md here tells how it is used.
namespace facewire::bus {

// Positions are in the servo's own unit: us of pulse width, or counts.
struct ServoConfig {
  std::uint8_t id = 0;  // the channel of a Maestro, or the servo's id
  float min = 0;        // nothing outside min..max is ever sent
  float max = 0;
  // Where a failsafe of the bus's own takes the servo when the device falls silent: of a receiver
  // alone, the others have none that moves. NaN: the middle of min..max.
  float neutral = std::numeric_limits<float>::quiet_NaN();
  // How fast a servo that has just got its torque goes to where it is told to be, until it is
  // there; kept by the servo itself, where the bus has a means for it. > 0.
  float arrive_speed_per_s = 400;
  float arrive_acceleration_per_s2 = 2000;  // 0: unlimited
  // How fast the servo itself may go afterwards; somewhat above what it is told to. It bounds the
  // leap over goals that were lost. 0: unlimited.
  float top_speed_per_s = 0;
  GuardConfig guard{};
};

struct BusConfig {
  InlineVector<ServoConfig, kMaxServos> servos;
  std::uint32_t baud = 1'000'000;  // tells how long bytes take
  // A reply that has not come by then is lost. USB adapters hold bytes back for 16 ms unless their
  // latency timer is set to less.
  Duration reply_timeout = std::chrono::milliseconds(20);
  float feedback_share = 0.25F;  // of the line's time for questions and their replies, 0.01..0.9
  Duration refresh = std::chrono::milliseconds(100);      // what does not change is sent again
  Duration look_after = std::chrono::milliseconds(1000);  // torque, goal and faults are compared
  Duration retry = std::chrono::milliseconds(500);  // between two tries to find who is missing
  Duration torque_interval = std::chrono::milliseconds(50);  // not all motors start at once
  std::uint8_t gone_after = 5;                               // replies lost in a row
};

struct ServoCommand {
  // NaN or infinite: as before. Without torque of no meaning; with torque, but not a single number
  // yet, the servo stays limp.
  float position = std::numeric_limits<float>::quiet_NaN();
  bool torque = false;
};

enum class ServoState : std::uint8_t {
  kAbsent,    // does not answer (yet, or any more)
  kChecking,  // its settings and position are being read
  kRefused,   // a setting makes it unsafe to move (BusStatus::findings); it is left limp
  kLimp,      // well, and without torque
  kArming,    // is being told where to be, and then gets torque
  kOn,        // has torque and follows
};
const char* Name(ServoState state) noexcept;

struct ServoFeedback {
  ServoState state = ServoState::kAbsent;
  bool torque = false;            // as the servo itself last said
  std::optional<float> position;  // own unit; of a controller of pulses the one that it makes
  Time position_read{};           // when
  std::optional<float> temperature_c;
  std::optional<float> load;  // -1..1 of what it can do; where the bus tells
  std::optional<float> voltage_v;
  HardwareFaults faults = 0;      // bits of HardwareFault
  float factor = 1;               // for the motion: 1 full speed .. 0 let go
  Reason reason = Reason::kNone;  // why factor is below 1
  std::uint64_t lost = 0;         // replies
};

enum class BusState : std::uint8_t { kStarting, kChecking, kRunning, kFault };
const char* Name(BusState state) noexcept;

enum class BusFault : std::uint8_t {
  kNone,
  kNotConfigured,
  kNobodyAnswers,  // wrong port or rate, no power, or the controller's mode
  kEcho,           // the line gives back what is sent: the adapter is wired wrongly
  kSettings,       // every servo that answers was refused
};
const char* Name(BusFault fault) noexcept;

// What a bus holds by itself and a rig has wishes about.
enum class Setting : std::uint8_t {
  kOperatingMode,
  kMinPosition,   // counts
  kMaxPosition,   // counts
  kShutdown,      // HardwareFaults that switch torque off
  kReturnDelay,   // us
  kProfileUnit,   // 1: a time instead of a speed
  kLock,          // 1: EEPROM is protected
  kBaudRate,      // as its register has it
  kPulseRange,    // the board sends another pulse than it was told: 0.25 us
  kSerialErrors,  // bits of wire::maestro::Error
  kOutputs,       // of a receiver, fewer than the servo's id needs
};
const char* Name(Setting setting) noexcept;

// A disagreement between a servo and its rig.
struct Finding {
  std::uint8_t servo = 0;  // index into BusConfig::servos
  Setting setting = Setting::kOperatingMode;
  std::int32_t found = 0;
  std::int32_t wanted = 0;
  bool refused = false;  // the servo is left limp because of it
};
inline constexpr std::size_t kMaxFindings = 2 * kMaxServos;
using Findings = InlineVector<Finding, kMaxFindings>;
// Keeps one finding for each servo and setting: the newest, or none when it is fine. Beyond the
// capacity nothing is added: the first ones are enough to begin with.
void NoteFinding(Findings& findings, const Finding& finding, bool fine) noexcept;

struct BusStatus {
  BusState state = BusState::kStarting;
  BusFault fault = BusFault::kNotConfigured;  // why, in kFault
  Findings findings;
  std::uint64_t questions = 0;
  std::uint64_t replies = 0;
  std::uint64_t lost = 0;           // replies that did not come in time
  std::uint64_t held_back = 0;      // ticks in which nothing was sent because a reply was due
  std::uint64_t torque_lost = 0;    // times that a servo had dropped its torque by itself
  std::uint16_t serial_errors = 0;  // of a Maestro: bits of wire::maestro::Error since the start
};

struct BusTraits {
  float step = 1;           // of positions
  bool reads_back = false;  // tells where the servos are, with and without torque
};

// The most that one Tick or Release returns.
inline constexpr std::size_t kMaxTickBytes = 2048;

// One thread. `now` of all calls is of one clock and should not go back.
class ServoBus {
 public:
  // What came from the port, cut anywhere, as soon as it came.
  virtual void Receive(std::span<const std::byte> bytes, Time now) noexcept = 0;
  // At the output's steady rate: what to write to the port now, possibly nothing; valid until the
  // next call. `commands` in the order of BusConfig::servos; one that is missing means no torque.
  virtual std::span<const std::byte> Tick(Time now,
                                          std::span<const ServoCommand> commands) noexcept = 0;
  // What lets go of all servos at once, whatever else goes on: on a stop, and before the port is
  // closed. Unlike Tick it may talk into a reply, so the Ticks after it see to it that every
  // servo has heard, as long as their commands ask for no torque.
  virtual std::span<const std::byte> Release(Time now) noexcept = 0;
  // The port is new, or was gone: find everybody again. Heat and load are remembered.
  virtual void Restart() noexcept = 0;
  // One servo starts anew with one of the next ticks, which clears its hardware faults. It is
  // limp until it is back. kOutOfRange: no such servo; kUnsupported: the bus cannot.
  virtual Result<> Reboot(std::size_t servo) noexcept = 0;

  virtual std::span<const ServoFeedback> feedback() const noexcept = 0;
  virtual const BusStatus& status() const noexcept = 0;
  virtual BusTraits traits() const noexcept = 0;

 protected:
  // Nobody owns a bus through this interface: core has no heap.
  ~ServoBus() = default;
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_SERVO_BUS_H_
