#ifndef FACEWIRE_TESTS_SIM_SERVO_MODEL_H_
#define FACEWIRE_TESTS_SIM_SERVO_MODEL_H_

#include <cstdint>
#include <limits>

#include "tests/sim/random.h"
#include "tests/sim/servo_parameters.h"

namespace facewire::sim {

// The physics of one servo in steps of a millisecond: a direct-current motor on a straight
// torque-speed line, gears with friction and play, a position sensor at the output shaft, a
// proportional position loop with dead band, and one lump of heat. Knows nothing of wires.
class ServoModel {
 public:
  static constexpr double kStepSeconds = 0.001;
  static constexpr double kRoomCelsius = 25;

  ServoModel(const ServoParameters& parameters, const ServoLoad& load, double start_rad,
             std::uint64_t seed);

  // What its electronics do with the motor, until told otherwise.
  void Release() { drive_ = Drive::kFree; }
  void Brake() { drive_ = Drive::kBrake; }  // the motor's ends tied together
  void GoTo(double goal_rad);
  void Turn(double speed_radps);
  void Push(double duty);                              // -1..1 of the voltage
  void LimitDuty(double duty) { duty_limit_ = duty; }  // 0..1
  void LimitCurrent(double limit_A) { current_limit_A_ = limit_A; }

  // Moves on by kStepSeconds.
  void Step(double supply_V);

  const ServoParameters& parameters() const { return parameters_; }
  double position_rad() const { return output_rad_; }  // of the output shaft, true
  double sensed_rad() const { return sensed_rad_; }    // noisy, in the sensor's steps
  double speed_radps() const { return speed_radps_; }
  double current_A() const { return current_A_; }  // of the motor, signed
  double torque_Nm() const { return torque_constant_ * current_A_; }
  double duty() const { return duty_; }
  double temperature_C() const { return temperature_C_; }
  double supply_current_A() const;
  bool driven() const { return drive_ > Drive::kBrake && !burnt_; }
  bool burnt() const { return burnt_; }

  // Faults.
  void Heat(double temperature_C) { temperature_C_ = temperature_C; }
  // The mechanism does not go past `position_rad` any more, from the side where it is now.
  void Jam(double position_rad);
  void Unjam();
  void SetSensorError(double error_rad) { sensor_error_rad_ = error_rad; }

 private:
  enum class Drive { kFree, kBrake, kPosition, kSpeed, kDuty };

  double WantedDuty() const;
  double LoadTorque() const;
  void Move(double torque_Nm);
  void FollowWithPlay(double load_Nm);
  void Sense();

  ServoParameters parameters_;
  ServoLoad load_;
  Random random_;
  // Derived from the parameters.
  double resistance_ohm_, torque_constant_, speed_constant_, inertia_, friction_Nm_, punch_,
      damping_;
  double lower_rad_, upper_rad_;

  Drive drive_ = Drive::kFree;
  double goal_ = 0;
  double duty_limit_ = 1;
  double current_limit_A_ = std::numeric_limits<double>::infinity();

  double motor_rad_, output_rad_, sensed_rad_;  // motor_rad_: the last gear before the play
  double speed_radps_ = 0;
  double duty_ = 0;
  double current_A_ = 0;
  double temperature_C_ = kRoomCelsius;
  double sensor_error_rad_ = 0;
  bool burnt_ = false;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_SERVO_MODEL_H_
