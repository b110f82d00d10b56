#include "tests/sim/servo_model.h"

#include <algorithm>
#include <cmath>

namespace facewire::sim {

ServoModel::ServoModel(const ServoParameters& parameters, const ServoLoad& load, double start_rad,
                       std::uint64_t seed)
    : parameters_(parameters),
      load_(load),
      random_(seed),
      resistance_ohm_(parameters.nominal_V / parameters.stall_current_A),
      // The stall torque of a datasheet is what is left of the motor's after the gears' friction.
      torque_constant_(parameters.stall_torque_Nm /
                       (parameters.stall_current_A - parameters.no_load_current_A)),
      speed_constant_((parameters.nominal_V - resistance_ohm_ * parameters.no_load_current_A) /
                      parameters.no_load_speed_radps),
      inertia_(parameters.mechanical_time_constant_s * torque_constant_ * speed_constant_ /
               resistance_ohm_ * (1 + load.inertia_share)),
      friction_Nm_(torque_constant_ * parameters.no_load_current_A),
      punch_(parameters.no_load_current_A / parameters.stall_current_A),
      lower_rad_(parameters.lower_stop_rad),
      upper_rad_(parameters.upper_stop_rad),
      motor_rad_(std::clamp(start_rad, lower_rad_, upper_rad_)),
      output_rad_(motor_rad_),
      sensed_rad_(motor_rad_) {
  // Critical damping of the position loop, on top of what the motor's own voltage gives.
  const double speed = parameters.no_load_speed_radps;
  const double time_constant = parameters.mechanical_time_constant_s * (1 + load.inertia_share);
  damping_ =
      std::max(0.0, 2 * std::sqrt(time_constant * speed / parameters.full_drive_error_rad) - 1) /
      speed;
  Sense();
}

void ServoModel::GoTo(double goal_rad) {
  drive_ = Drive::kPosition;
  goal_ = goal_rad;
}

void ServoModel::Turn(double speed_radps) {
  drive_ = Drive::kSpeed;
  goal_ = speed_radps;
}

void ServoModel::Push(double duty) {
  drive_ = Drive::kDuty;
  goal_ = duty;
}

double ServoModel::WantedDuty() const {
  if (drive_ == Drive::kBrake) return 0;
  if (drive_ == Drive::kDuty) return goal_;
  if (drive_ == Drive::kSpeed) {
    // The duty that the speed needs, and a tenth of the voltage for every tenth of error.
    const double top = parameters_.no_load_speed_radps;
    const double start = goal_ > 0 ? punch_ : (goal_ < 0 ? -punch_ : 0);
    return start + goal_ / top + (goal_ - speed_radps_) / top;
  }
  const double error = goal_ - sensed_rad_;
  const double beyond = std::abs(error) - parameters_.dead_band_rad;
  if (beyond <= 0) return -damping_ * speed_radps_;
  // The smallest duty is what overcomes the gears' friction, as servos are set up in the works.
  const double drive = punch_ + beyond / parameters_.full_drive_error_rad;
  return std::copysign(drive, error) - damping_ * speed_radps_;
}

// On the output shaft, positive towards larger angles.
double ServoModel::LoadTorque() const {
  double torque = 0;
  if (load_.gravity_Nm != 0) {
    torque -= load_.gravity_Nm * std::sin(output_rad_ - load_.gravity_down_rad);
  }
  return torque - load_.spring_Nm_per_rad * (output_rad_ - load_.spring_rest_rad);
}

void ServoModel::Move(double torque_Nm) {
  const double friction = friction_Nm_ + load_.friction_Nm;
  if (speed_radps_ == 0) {
    if (std::abs(torque_Nm) <= friction) return;
    speed_radps_ = (torque_Nm - std::copysign(friction, torque_Nm)) / inertia_ * kStepSeconds;
  } else {
    const double braked = speed_radps_ + (torque_Nm - std::copysign(friction, speed_radps_)) /
                                             inertia_ * kStepSeconds;
    // Friction stops a motion, it never turns one round.
    speed_radps_ = braked * speed_radps_ > 0 ? braked : 0;
  }
  motor_rad_ += speed_radps_ * kStepSeconds;
  if (motor_rad_ >= upper_rad_ || motor_rad_ <= lower_rad_) {
    motor_rad_ = std::clamp(motor_rad_, lower_rad_, upper_rad_);
    speed_radps_ = 0;
  }
}

// The output shaft lies anywhere within the play, and falls to the side that its load pulls to.
void ServoModel::FollowWithPlay(double load_Nm) {
  constexpr double kFallSpeed = 5;
  const double half = parameters_.backlash_rad / 2;
  if (std::abs(load_Nm) > load_.friction_Nm) {
    output_rad_ += std::copysign(kFallSpeed * kStepSeconds, load_Nm);
  }
  output_rad_ = std::clamp(output_rad_, motor_rad_ - half, motor_rad_ + half);
}

void ServoModel::Sense() {
  const double noise = parameters_.sensor_noise_rad * random_.Between(-1, 1) + sensor_error_rad_;
  sensed_rad_ =
      std::round((output_rad_ + noise) / parameters_.sensor_step_rad) * parameters_.sensor_step_rad;
}

void ServoModel::Step(double supply_V) {
  if (drive_ != Drive::kFree && !burnt_) {
    duty_ = std::clamp(WantedDuty(), -duty_limit_, duty_limit_);
    current_A_ = std::clamp((duty_ * supply_V - speed_constant_ * speed_radps_) / resistance_ohm_,
                            -current_limit_A_, current_limit_A_);
  } else {
    duty_ = 0;
    current_A_ = 0;
  }
  const double load = LoadTorque();
  Move(torque_constant_ * current_A_ + load);
  FollowWithPlay(load);
  Sense();

  const double loss_W = current_A_ * current_A_ * resistance_ohm_;
  temperature_C_ += (kRoomCelsius + loss_W * parameters_.heat_rise_C_per_W - temperature_C_) *
                    kStepSeconds / parameters_.heat_time_constant_s;
  if (temperature_C_ >= parameters_.burns_at_C) burnt_ = true;
}

double ServoModel::supply_current_A() const {
  return parameters_.idle_current_A + std::max(0.0, duty_ * current_A_);
}

void ServoModel::Jam(double position_rad) {
  (motor_rad_ <= position_rad ? upper_rad_ : lower_rad_) = position_rad;
}

void ServoModel::Unjam() {
  lower_rad_ = parameters_.lower_stop_rad;
  upper_rad_ = parameters_.upper_stop_rad;
}

}  // namespace facewire::sim
