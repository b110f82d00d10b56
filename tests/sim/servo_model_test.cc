#include "tests/sim/servo_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace facewire::sim {
namespace {

constexpr double kLevel = 90 * kDegree;  // an arm that hangs down at 0 is level here

ServoModel Unloaded(const ServoParameters& parameters, double start_rad = 0) {
  return ServoModel(parameters, ServoLoad{}, start_rad, 1);
}

void RunFor(ServoModel& servo, double seconds, double supply_V) {
  for (int i = 0; i < static_cast<int>(seconds / ServoModel::kStepSeconds); ++i)
    servo.Step(supply_V);
}

double SecondsBetween(ServoModel& servo, double from_rad, double to_rad, double supply_V) {
  int steps = 0;
  for (int i = 0; i < 20'000 && servo.position_rad() < to_rad; ++i) {
    servo.Step(supply_V);
    if (servo.position_rad() >= from_rad) ++steps;
  }
  return steps * ServoModel::kStepSeconds;
}

class EveryServo : public testing::TestWithParam<ServoParameters> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryServo,
                         testing::Values(HobbyServo(), Xl330M288(), Xl430W250(), Sts3215(), Sc09()),
                         [](const auto& kind) {
                           std::string name = kind.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(EveryServo, TurnsSixtyDegreesInItsDatasheetsTime) {
  const ServoParameters p = GetParam();
  ServoModel servo = Unloaded(p, -80 * kDegree);
  servo.GoTo(80 * kDegree);
  const double expected = 60 * kDegree / p.no_load_speed_radps;
  EXPECT_NEAR(SecondsBetween(servo, -30 * kDegree, 30 * kDegree, p.nominal_V), expected,
              0.05 * expected + 0.001);
}

TEST_P(EveryServo, IsSlowerAtLowerVoltage) {
  const ServoParameters p = GetParam();
  ServoModel servo = Unloaded(p, -80 * kDegree);
  servo.GoTo(80 * kDegree);
  const double expected = 60 * kDegree / p.no_load_speed_radps;
  EXPECT_GT(SecondsBetween(servo, -30 * kDegree, 30 * kDegree, 0.8 * p.nominal_V), 1.2 * expected);
}

TEST_P(EveryServo, StallsAtItsDatasheetsTorqueAndCurrent) {
  const ServoParameters p = GetParam();
  ServoModel servo = Unloaded(p);
  servo.Jam(0);
  servo.GoTo(80 * kDegree);
  RunFor(servo, 0.5, p.nominal_V);
  EXPECT_NEAR(servo.current_A(), p.stall_current_A, 1e-6);
  const double gears = p.no_load_current_A / p.stall_current_A * servo.torque_Nm();
  EXPECT_NEAR(servo.torque_Nm() - gears, p.stall_torque_Nm, 1e-6);
}

TEST_P(EveryServo, ArrivesWithoutOvershootAndStaysStill) {
  const ServoParameters p = GetParam();
  ServoModel servo = Unloaded(p);
  servo.GoTo(30 * kDegree);
  double most = 0;
  for (int i = 0; i < 2000; ++i) {
    servo.Step(p.nominal_V);
    most = std::max(most, servo.position_rad());
  }
  EXPECT_LT(most, 31.5 * kDegree);
  const double arrived = servo.position_rad();
  EXPECT_NEAR(arrived, 30 * kDegree, p.dead_band_rad + p.backlash_rad / 2 + 2 * p.sensor_step_rad);
  RunFor(servo, 1, p.nominal_V);
  EXPECT_NEAR(servo.position_rad(), arrived, p.backlash_rad / 2 + p.sensor_step_rad);
}

TEST_P(EveryServo, HardlyHeatsWhenItHoldsNothing) {
  const ServoParameters p = GetParam();
  ServoModel servo = Unloaded(p);
  servo.GoTo(10 * kDegree);
  RunFor(servo, 120, p.nominal_V);
  EXPECT_LT(servo.temperature_C(), ServoModel::kRoomCelsius + 5);
}

TEST(ServoModel, GivesWayUnderAConstantLoad) {
  const ServoParameters p = Sts3215();
  // The measurement of README.md: half the stall torque, 20 to 30 counts.
  const ServoLoad arm{.gravity_Nm = 0.5 * p.stall_torque_Nm};
  ServoModel servo(p, arm, kLevel, 1);
  servo.GoTo(kLevel);
  RunFor(servo, 2, p.nominal_V);
  const double counts = (kLevel - servo.position_rad()) * 4096 / (2 * std::numbers::pi);
  EXPECT_GT(counts, 15);
  EXPECT_LT(counts, 40);
}

TEST(ServoModel, FallsWhenItIsReleased) {
  const ServoLoad arm{.gravity_Nm = 0.2};
  ServoModel servo(Xl330M288(), arm, kLevel, 1);
  servo.GoTo(kLevel);
  RunFor(servo, 1, 5);
  EXPECT_GT(servo.position_rad(), 80 * kDegree);
  servo.Release();
  RunFor(servo, 2, 5);
  EXPECT_LT(servo.position_rad(), 30 * kDegree);
  EXPECT_EQ(servo.current_A(), 0);
}

TEST(ServoModel, FallsSlowerWhenItBrakes) {
  const ServoLoad arm{.gravity_Nm = 0.2};
  ServoModel falls(Xl330M288(), arm, kLevel, 1);
  ServoModel brakes(Xl330M288(), arm, kLevel, 1);
  brakes.Brake();
  RunFor(falls, 0.1, 5);
  RunFor(brakes, 0.1, 5);
  EXPECT_LT(falls.position_rad(), brakes.position_rad());
  EXPECT_LT(brakes.position_rad(), kLevel);
  EXPECT_FALSE(brakes.driven());
}

TEST(ServoModel, StaysWhereItIsReleasedWhenItsGearsHoldTheLoad) {
  const ServoLoad light{.gravity_Nm = 0.01};
  ServoModel servo(Xl330M288(), light, kLevel, 1);
  RunFor(servo, 2, 5);
  EXPECT_NEAR(servo.position_rad(), kLevel, 0.3 * kDegree);
}

TEST(ServoModel, ItsShaftStandsStillForThePlayWhenTheDirectionTurns) {
  const ServoParameters p = Sts3215();
  constexpr double kSpeed = 0.5;
  ServoModel servo = Unloaded(p);
  servo.Turn(kSpeed);
  RunFor(servo, 0.5, p.nominal_V);
  servo.Turn(-kSpeed);
  int still_ms = 0;
  double before = 0;
  do {
    before = servo.position_rad();
    servo.Step(p.nominal_V);
    if (servo.position_rad() == before) ++still_ms;
  } while (servo.position_rad() >= before);
  EXPECT_NEAR(still_ms, 1000 * p.backlash_rad / kSpeed, 10);
}

TEST(ServoModel, LeavesAnErrorWithinItsDeadBand) {
  ServoModel servo = Unloaded(HobbyServo());
  servo.GoTo(0.3 * kDegree);
  RunFor(servo, 1, 4.8);
  EXPECT_EQ(servo.position_rad(), 0);
  EXPECT_EQ(servo.duty(), 0);
}

TEST(ServoModel, BurnsWhenAHobbyServoIsStalledForMinutes) {
  ServoModel servo = Unloaded(HobbyServo());
  servo.Jam(0);
  servo.GoTo(80 * kDegree);
  RunFor(servo, 20, 4.8);
  EXPECT_FALSE(servo.burnt());
  RunFor(servo, 280, 4.8);
  EXPECT_TRUE(servo.burnt());
  EXPECT_EQ(servo.current_A(), 0);
  servo.Unjam();
  const double here = servo.position_rad();
  RunFor(servo, 1, 4.8);
  EXPECT_EQ(servo.position_rad(), here);
}

TEST(ServoModel, HeatsWithItsTimeConstant) {
  const ServoParameters p = Xl330M288();
  ServoModel servo = Unloaded(p);
  servo.Jam(0);
  servo.LimitCurrent(0.5);
  servo.GoTo(80 * kDegree);
  const double loss_W = 0.5 * 0.5 * p.nominal_V / p.stall_current_A;
  RunFor(servo, p.heat_time_constant_s, p.nominal_V);
  EXPECT_NEAR(servo.temperature_C() - ServoModel::kRoomCelsius,
              loss_W * p.heat_rise_C_per_W * (1 - std::exp(-1)), 0.1);
}

TEST(ServoModel, StopsWhereItsMechanismJams) {
  ServoModel servo = Unloaded(Sts3215());
  servo.Jam(20 * kDegree);
  servo.GoTo(40 * kDegree);
  RunFor(servo, 1, 7.4);
  EXPECT_NEAR(servo.position_rad(), 20 * kDegree, 0.6 * kDegree);
  EXPECT_GT(servo.current_A(), 2);
}

TEST(ServoModel, FollowsAJumpOfItsSensor) {
  ServoModel servo = Unloaded(Sts3215());
  servo.GoTo(0);
  servo.SetSensorError(5 * kDegree);
  RunFor(servo, 1, 7.4);
  EXPECT_NEAR(servo.position_rad(), -5 * kDegree, 1 * kDegree);
}

TEST(ServoModel, TakesLittleMoreThanItsIdleCurrentWhenItRests) {
  ServoModel servo = Unloaded(Xl430W250());
  RunFor(servo, 0.1, 11.1);
  EXPECT_EQ(servo.supply_current_A(), 0.052);
}

}  // namespace
}  // namespace facewire::sim
