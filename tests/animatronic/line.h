#ifndef FACEWIRE_TESTS_ANIMATRONIC_LINE_H_
#define FACEWIRE_TESTS_ANIMATRONIC_LINE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/bus/dynamixel_bus.h"
#include "core/bus/feetech_bus.h"
#include "core/bus/maestro_bus.h"
#include "core/bus/receiver_bus.h"
#include "core/servo/servo_rig.h"
#include "tests/animatronic/judge.h"
#include "tests/sim/bus.h"

namespace facewire::stage {

enum class Kind : std::uint8_t { kMaestro, kReceiver, kDynamixel, kSts, kScs };
inline constexpr std::array kKinds = {Kind::kMaestro, Kind::kReceiver, Kind::kDynamixel, Kind::kSts,
                                      Kind::kScs};
const char* Name(Kind kind);

// Hobby servos behind pulses, of which nobody knows where they are; the others tell.
constexpr bool IsPulses(Kind kind) { return kind == Kind::kMaestro || kind == Kind::kReceiver; }
// Degrees of one unit of the servo: 0.09 of a microsecond, 360 / 4096 or 300 / 1024 of a count.
double DegreesPerUnit(Kind kind);

// A servo of this kind as a builder would describe it: 90 degrees (a hobby servo's 1000 us) with
// the neutral in the middle, and a rule-of-thumb speed of 270 degrees a second, that all kinds can
// do. One source, "p" and its number: 0 to 1 from end to end.
servo::Servo ServoOf(Kind kind, std::size_t number, std::uint8_t id);

struct LineOptions {
  Kind kind = Kind::kMaestro;
  std::size_t servos = 3;
  Duration period = std::chrono::milliseconds(10);
  std::vector<double>
      poses{};  // at power-on, in the servo's unit; those beyond the end: the middle
  Duration serial_timeout = std::chrono::milliseconds(500);  // of a Maestro; zero: off
  bool multi_target = false;  // a Mini Maestro, all targets in one packet
  bool crc = false;           // of a Maestro
  bool home_neutral = false;  // of a Maestro: on an error to neutral, otherwise pulses off
  sim::LineFaults faults{};
  std::uint64_t seed = 1;
};

// One bus of the rig: the driver on the host's side, the simulated bus on the other, and the cable
// between them, which can be cut in both directions.
class Line {
 public:
  // `servos` are those of the rig that hang here. What the bus holds itself (limits in EEPROM) is
  // as `facewire servo` would have set it.
  Line(const LineOptions& options, const servo::Contract& contract,
       std::span<const servo::Servo> servos);

  // A new one, which knows nothing: the host's program has started (again).
  void StartDriver();

  const LineOptions& options() const { return options_; }
  bus::ServoBus& driver() { return *driver_; }
  sim::Bus& bus() { return *bus_; }
  Seen Look(std::size_t servo) const;
  // What a judge has to know of servo `servo`.
  Wire wire(std::size_t servo) const;

  void ToServos(std::span<const std::byte> bytes, Time world);
  std::vector<std::byte> ToHost();

  // The cable: both ways at once, after so many more bytes to the servos; or one way.
  void CutAfter(std::size_t bytes) { left_ = bytes; }
  void Mend() {
    left_.reset();
    deaf = silent = false;
  }
  bool whole() const { return !deaf && !silent && !left_; }
  bool deaf = false;    // nothing gets to the servos
  bool silent = false;  // nothing gets to the host
  // May change what gets to the host.
  std::function<void(std::vector<std::byte>&)> damage;

 private:
  void BuildMaestro();
  void BuildReceiver();
  void BuildDynamixel();
  void BuildFeetech();

  LineOptions options_;
  servo::Contract contract_;
  std::vector<servo::Servo> servos_;
  std::variant<bus::MaestroBus, bus::ReceiverBus, bus::DynamixelBus, bus::FeetechBus> drivers_;
  bus::ServoBus* driver_ = nullptr;
  std::unique_ptr<sim::Bus> bus_;
  std::optional<std::size_t> left_;  // until the cable is cut
};

}  // namespace facewire::stage

#endif  // FACEWIRE_TESTS_ANIMATRONIC_LINE_H_
