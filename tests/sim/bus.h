#ifndef FACEWIRE_TESTS_SIM_BUS_H_
#define FACEWIRE_TESTS_SIM_BUS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/time.h"
#include "tests/sim/faults.h"
#include "tests/sim/line.h"
#include "tests/sim/servo_model.h"
#include "tests/sim/trace.h"

namespace facewire::sim {

// What all kinds of bus have. Filled with the defaults of the kind by its own options.
struct BusOptions {
  ServoParameters servo = HobbyServo();
  std::vector<ServoLoad> loads;  // by servo; those beyond the end have none
  // Positions at power-on by servo, in its own unit; those beyond the end start in the middle.
  std::vector<double> poses;
  double baud = 1'000'000;
  bool echo = false;  // the host's adapter gives it its own bytes back, as simple ones do
  double supply_V = 5;
  double supply_ohm = 0.05;  // of the wires and the supply that all servos share
  FaultPlan faults;
  std::uint64_t seed = 1;
};

// A bus and its servos, as a host sees them: bytes in, bytes out, in virtual time. Times never go
// back. An hour of traffic takes seconds, because nothing here waits.
class Bus {
 public:
  virtual ~Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // The host writes `bytes` at `now`: they go out at the line's rate, after what it wrote before.
  // The first call of this or Advance starts the bus's life.
  void Receive(std::span<const std::byte> bytes, Time now);
  // Everything that happens until `now`, that included.
  void Advance(Time now);
  // The bytes that have reached the host by the time of the last Advance or Receive.
  std::vector<std::byte> Transmit();
  // When the next byte will have reached the host; Time::max() when none is on its way yet.
  Time NextTransmit() const;

  // Who hosts the bus has set another rate on its line. Servos of a chain hear at their own alone.
  void SetBaud(double baud) { line_.SetBaud(baud); }
  double baud() const { return line_.baud(); }

  std::size_t servos() const { return models_.size(); }
  ServoModel& servo(std::size_t index) { return models_[index]; }
  const ServoModel& servo(std::size_t index) const { return models_[index]; }
  Trace& trace() { return trace_; }
  LineFaults& line_faults() { return line_.faults(); }
  // A fault on top of those of the options; one whose time has passed begins at once.
  void Inject(const Fault& fault);
  double supply_V() const { return voltage_V_; }
  Time now() const { return now_; }

  // In the servo's own unit, as Sample says it: what the host last asked for, where the servo is
  // told to be right now, and where it truly is.
  virtual double Goal(std::size_t index) const = 0;
  virtual double Commanded(std::size_t index) const = 0;
  double Position(std::size_t index) const { return ToOwn(models_[index].position_rad()); }
  bool TorqueOn(std::size_t index) const { return models_[index].driven(); }

  virtual double ToOwn(double rad) const = 0;
  virtual double ToRad(double own) const = 0;

 protected:
  Bus(const BusOptions& options, std::size_t servos, double middle, double own_per_rad,
      bool half_duplex);

  // A byte has reached the servos.
  virtual void OnByte(std::uint8_t byte, Nanos at) = 0;
  // A millisecond is over: what the controllers do, before the servos move.
  virtual void OnMillisecond(Time at) = 0;
  // Servo `index` has its power (again): everything is as its permanent memory says.
  virtual void OnPowerUp(std::size_t index) = 0;

  // Whether the servo has power and has started; and whether it hears and answers, too.
  bool Running(std::size_t index) const;
  bool Answers(std::size_t index) const { return Running(index) && !conditions_[index].mute; }
  // Nothing happens in the servo for as long as it takes to start.
  void StartAnew(std::size_t index, Duration takes);
  // Puts a reply on the wire, `delay` after `at`. Returns when its last byte is out.
  Nanos Reply(std::span<const std::uint8_t> bytes, Nanos at, Nanos delay);
  void Happened(EventKind kind, int servo, int detail);

 private:
  struct Condition {
    bool powered = true;
    bool mute = false;
    bool burnt = false;
    bool driven = false;
    Time starts{};  // while in the future, the servo is starting
    bool starting = false;
  };

  void Millisecond();
  void RunFaults();
  void Begin(const Fault& fault);
  void End(const Fault& fault);
  void Record();

  Line line_;
  Trace trace_;
  std::vector<ServoModel> models_;
  std::vector<Condition> conditions_;
  std::vector<Fault> coming_;   // the next one last
  std::vector<Fault> present_;  // those that will end
  double open_supply_V_, supply_ohm_, voltage_V_;
  double own_per_rad_;
  bool started_ = false;
  Time start_{}, now_{}, tick_{};
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_BUS_H_
