#ifndef FACEWIRE_TESTS_SIM_SERVO_PARAMETERS_H_
#define FACEWIRE_TESTS_SIM_SERVO_PARAMETERS_H_

#include <numbers>

namespace facewire::sim {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kRpm = 2 * std::numbers::pi / 60;
constexpr double kEndless = 1000;                  // radians: no stop
constexpr double kKilogramCentimetre = 0.0980665;  // of torque, in Nm

// One kind of servo: motor, gears, sensor and case. All angles, speeds and torques are those of the
// output shaft. README.md names the source of every number below, and says which are assumed.
struct ServoParameters {
  const char* name;
  // The torque-speed line is straight between these two ends and scales with the voltage.
  double nominal_V;
  double no_load_speed_radps;
  double stall_torque_Nm;
  double stall_current_A;
  double no_load_current_A;  // what the gears' friction takes
  double idle_current_A;     // electronics
  double mechanical_time_constant_s;
  // Position control.
  double full_drive_error_rad;  // the error from which on the motor gets the whole voltage
  double dead_band_rad;         // errors that the controller leaves alone
  double backlash_rad;
  double sensor_step_rad;
  double sensor_noise_rad;  // largest
  double lower_stop_rad, upper_stop_rad;
  // Heat.
  double heat_rise_C_per_W;
  double heat_time_constant_s;
  double burns_at_C;
  double brown_out_V;  // below it the electronics start anew
};

// A plastic-geared 9 g servo (SG90 class) behind a pulse controller. Protects itself from nothing.
constexpr ServoParameters HobbyServo() {
  return {
      .name = "hobby",
      .nominal_V = 4.8,
      .no_load_speed_radps = 60 * kDegree / 0.10,
      .stall_torque_Nm = 1.8 * kKilogramCentimetre,
      .stall_current_A = 0.65,
      .no_load_current_A = 0.10,
      .idle_current_A = 0.006,
      .mechanical_time_constant_s = 0.010,
      .full_drive_error_rad = 6 * kDegree,
      .dead_band_rad = 0.45 * kDegree,
      .backlash_rad = 1.0 * kDegree,
      .sensor_step_rad = 0.09 * kDegree,
      .sensor_noise_rad = 0.10 * kDegree,
      .lower_stop_rad = -95 * kDegree,
      .upper_stop_rad = 95 * kDegree,
      .heat_rise_C_per_W = 35,
      .heat_time_constant_s = 50,
      .burns_at_C = 110,
      .brown_out_V = 3.0,
  };
}

constexpr ServoParameters Xl330M288() {
  return {
      .name = "XL330-M288",
      .nominal_V = 5.0,
      .no_load_speed_radps = 103 * kRpm,
      .stall_torque_Nm = 0.52,
      .stall_current_A = 1.47,
      .no_load_current_A = 0.10,
      .idle_current_A = 0.017,
      .mechanical_time_constant_s = 0.010,
      .full_drive_error_rad = 24.9 * kDegree,
      .dead_band_rad = 0.09 * kDegree,
      .backlash_rad = 0.25 * kDegree,
      .sensor_step_rad = 360.0 / 4096 * kDegree,
      .sensor_noise_rad = 0.05 * kDegree,
      .lower_stop_rad = -kEndless,
      .upper_stop_rad = kEndless,
      .heat_rise_C_per_W = 12,
      .heat_time_constant_s = 90,
      .burns_at_C = 140,
      .brown_out_V = 3.2,
  };
}

constexpr ServoParameters Xl430W250() {
  return {
      .name = "XL430-W250",
      .nominal_V = 11.1,
      .no_load_speed_radps = 57 * kRpm,
      .stall_torque_Nm = 1.4,
      .stall_current_A = 1.3,
      .no_load_current_A = 0.10,
      .idle_current_A = 0.052,
      .mechanical_time_constant_s = 0.010,
      .full_drive_error_rad = 15.6 * kDegree,
      .dead_band_rad = 0.09 * kDegree,
      .backlash_rad = 0.25 * kDegree,
      .sensor_step_rad = 360.0 / 4096 * kDegree,
      .sensor_noise_rad = 0.05 * kDegree,
      .lower_stop_rad = -kEndless,
      .upper_stop_rad = kEndless,
      .heat_rise_C_per_W = 7,
      .heat_time_constant_s = 180,
      .burns_at_C = 140,
      .brown_out_V = 5.5,
  };
}

constexpr ServoParameters Sts3215() {
  return {
      .name = "STS3215",
      .nominal_V = 7.4,
      .no_load_speed_radps = 52 * kRpm,
      .stall_torque_Nm = 19.5 * kKilogramCentimetre,
      .stall_current_A = 2.4,
      .no_load_current_A = 0.15,
      .idle_current_A = 0.006,
      .mechanical_time_constant_s = 0.010,
      .full_drive_error_rad = 5 * kDegree,
      .dead_band_rad = 360.0 / 4096 * kDegree,
      .backlash_rad = 1.0 * kDegree,
      .sensor_step_rad = 360.0 / 4096 * kDegree,
      .sensor_noise_rad = 0.05 * kDegree,
      .lower_stop_rad = -kEndless,
      .upper_stop_rad = kEndless,
      .heat_rise_C_per_W = 5,
      .heat_time_constant_s = 200,
      .burns_at_C = 140,
      .brown_out_V = 3.8,
  };
}

constexpr ServoParameters Sc09() {
  return {
      .name = "SC09",
      .nominal_V = 6.0,
      .no_load_speed_radps = 100 * kRpm,
      .stall_torque_Nm = 2.3 * kKilogramCentimetre,
      .stall_current_A = 1.0,
      .no_load_current_A = 0.15,
      .idle_current_A = 0.006,
      .mechanical_time_constant_s = 0.010,
      .full_drive_error_rad = 6 * kDegree,
      .dead_band_rad = 300.0 / 1024 * kDegree,
      .backlash_rad = 1.0 * kDegree,
      .sensor_step_rad = 300.0 / 1024 * kDegree,
      .sensor_noise_rad = 0.15 * kDegree,
      .lower_stop_rad = -150 * kDegree,
      .upper_stop_rad = 150 * kDegree,
      .heat_rise_C_per_W = 30,
      .heat_time_constant_s = 60,
      .burns_at_C = 140,
      .brown_out_V = 3.8,
  };
}

// What hangs on the shaft.
struct ServoLoad {
  double gravity_Nm = 0;        // largest, when the arm is level
  double gravity_down_rad = 0;  // where the arm hangs straight down
  double spring_Nm_per_rad = 0;
  double spring_rest_rad = 0;
  double friction_Nm = 0;
  double inertia_share = 0;  // of the motor's own inertia seen through the gears
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_SERVO_PARAMETERS_H_
