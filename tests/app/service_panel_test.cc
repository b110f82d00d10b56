// The service and the lines of its board: when it stops, and when the servos have power.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/app/performer.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Contains;
using S = ServiceState;
using wire::CommandCode;
using wire::CommandResult;

// An emergency stop that opens at a moment, which may be between two ticks.
class LineThatOpensAt final : public hal::GpioInput {
 public:
  LineThatOpensAt(hal::Clock& clock, Time at) : clock_(clock), at_(at) {}
  Result<> Open() override { return {}; }
  std::string_view reason() const override { return {}; }
  Result<bool> Get() override { return clock_.Now() >= at_; }

 private:
  hal::Clock& clock_;
  Time at_;
};

// From the opening of the contact to the first pose that says "stopped"; no pose after the opening
// moves anything. The face moves all the time.
Duration StopLatency(Duration opens_after, bool silent_camera) {
  ServiceContext c;
  c.BringToTracking();
  if (silent_camera) {
    c.camera.FallSilent();
    c.For(milliseconds(400));
  }
  const Time opens = c.clock.Now() + opens_after;
  LineThatOpensAt line(c.clock, opens);
  c.service.emplace(c.config,
                    ServiceParts{.camera = c.camera,
                                 .line = c.line,
                                 .clock = c.clock,
                                 .follower = c.follower,
                                 .capture = c.capture,
                                 .stop = &line,
                                 .servo_power = &c.power},
                    c.character);
  Time stopped{};
  float frozen = 0;
  for (int i = 0; i < 100; ++i) {
    c.follower.jaw = static_cast<float>(i % 20);
    c.Tick();
    if (c.clock.Now() < opens) continue;
    if (stopped == Time{}) {
      stopped = c.clock.Now();
      frozen = c.Jaw();
    }
    EXPECT_EQ(c.last_pose.state, S::kStopped) << "the first pose after the opening, and all others";
    EXPECT_EQ(c.Jaw(), frozen);
    EXPECT_FALSE(c.power.asserted());
  }
  return stopped - opens;
}

TEST(ServiceStopLine, EndsMotionWithinOneTickWheneverItOpens) {
  Duration longest_live{};
  Duration longest_silent{};
  for (int ms = 200; ms < 300; ++ms) {
    longest_live = std::max(longest_live, StopLatency(milliseconds(ms), false));
    longest_silent = std::max(longest_silent, StopLatency(milliseconds(ms), true));
  }
  std::printf(
      "longest from opening to the stopped pose: %.1f ms at 30 fps, %.1f ms without pictures\n",
      static_cast<double>(Seconds(longest_live)) * 1000,
      static_cast<double>(Seconds(longest_silent)) * 1000);
  EXPECT_LE(longest_live, milliseconds(34)) << "a picture's time";
  EXPECT_LE(longest_silent, milliseconds(50)) << "1 / min_rate_hz";
  EXPECT_GT(longest_silent, milliseconds(40)) << "it did open between ticks";
}

TEST(ServiceStopLine, IsLatchedAndSaysWhyItStoppedAndWhyItDoesNotGoOn) {
  ServiceContext c;
  c.BringToTracking();
  c.stop.Break(Errc::kIo);
  c.Tick();
  EXPECT_EQ(c.last_pose.state, S::kStopped);
  EXPECT_THAT(c.said, Contains("emergency stop: cannot be read, which counts as open"));
  c.button.Hold(true);
  c.For(milliseconds(2500));
  c.button.Hold(false);
  c.For(milliseconds(200));
  EXPECT_EQ(c.last_pose.state, S::kStopped);
  ASSERT_EQ(c.logged.size(), 1U);
  EXPECT_EQ(c.logged[0].result, CommandResult::kRefused);
  c.stop.Repair();
  c.For(seconds(2));
  EXPECT_EQ(c.last_pose.state, S::kStopped) << "good again is not released";
  c.button.Hold(true);
  c.For(milliseconds(2500));
  EXPECT_EQ(c.logged.back().result, CommandResult::kOk);
  EXPECT_EQ(c.last_pose.state, S::kTracking);
}

TEST(ServiceStopLine, OpenFromTheBeginningMeansThatNothingEverMoves) {
  ServiceContext c;
  c.stop.Hold(true);
  c.follower.failure.reset();
  c.For(seconds(2));
  for (const wire::Pose& pose : c.poses) {
    EXPECT_EQ(pose.state, S::kStopped);
    EXPECT_NEAR(wire::ValuesOf(pose, c.host_rig.rig()).values[0], 1, 1e-3);
  }
  EXPECT_EQ(c.power.changes().total(), 0U);
}

TEST(ServicePower, ComesWithTheFirstPoseAndGoesWithTheLastOne) {
  ServiceContext c;
  c.port.AcceptOnly(0);
  c.For(milliseconds(300));
  EXPECT_FALSE(c.power.asserted()) << "nobody has taken a pose";
  c.port.AcceptAll();
  c.Tick();
  c.Tick();
  EXPECT_TRUE(c.power.asserted());
  c.BringToTracking();
  EXPECT_TRUE(c.power.asserted());
  c.service->Quit();
  while (c.Tick()) EXPECT_TRUE(c.power.asserted()) << "it is moved to neutral first";
  EXPECT_FALSE(c.power.asserted());
  EXPECT_FALSE(c.led.asserted());
}

TEST(ServicePower, IsOffWhileStopped) {
  ServiceContext c;
  c.BringToTracking();
  c.SendCommand(CommandCode::kStop);
  c.Tick();
  EXPECT_FALSE(c.power.asserted());
  c.For(seconds(3));
  EXPECT_FALSE(c.power.asserted());
  c.SendCommand(CommandCode::kRelease);
  c.Tick();
  EXPECT_TRUE(c.power.asserted());
}

TEST(ServicePower, IsOffWhileResting) {
  ServiceContext c;
  c.BringToTracking();
  c.follower.failure = Errc::kNoFace;
  c.For(seconds(2));
  EXPECT_TRUE(c.power.asserted()) << "at neutral, but not yet for rest_after";
  c.For(seconds(5));
  EXPECT_EQ(c.last_pose.state, S::kResting);
  EXPECT_FALSE(c.power.asserted());
  c.follower.failure.reset();
  c.For(milliseconds(300));
  EXPECT_TRUE(c.power.asserted());
}

TEST(ServicePower, IsOffInAFaultWhichACameraReachesAtNeutralOnly) {
  ServiceContext c;
  c.BringToTracking();
  c.camera.Unplug();
  while (c.last_pose.state != S::kFault) {
    EXPECT_TRUE(c.power.asserted());
    c.Tick();
  }
  EXPECT_NEAR(c.Jaw(), 1, 1e-3) << "it does not fall from where it was";
  EXPECT_FALSE(c.power.asserted());
  c.camera.Plug();
  c.For(seconds(9));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  EXPECT_TRUE(c.power.asserted());
}

TEST(ServicePower, IsOffWhileTheLineIsGone) {
  ServiceContext c;
  c.BringToTracking();
  c.port.Unplug();
  c.Tick();
  c.Tick();
  EXPECT_FALSE(c.power.asserted());
  c.port.Plug();
  c.For(seconds(9));
  EXPECT_TRUE(c.power.asserted());
}

TEST(ServicePower, NeverComesWithoutALineToTheServos) {
  ServiceContext c;
  HostLine none(nullptr, c.clock, milliseconds(5));
  Service service(c.config,
                  {.camera = c.camera,
                   .line = none,
                   .clock = c.clock,
                   .follower = c.follower,
                   .capture = c.capture,
                   .servo_power = &c.power},
                  c.character);
  for (int i = 0; i < 100; ++i) service.Tick();
  EXPECT_EQ(c.power.changes().total(), 0U);
}

TEST(ServiceLight, ShowsTheStateAndACalibration) {
  ServiceContext c;
  c.follower.face = StillPerformer();
  c.BringToTracking();
  c.For(seconds(1));
  const std::uint64_t before = c.led.changes().total();
  c.For(seconds(1));
  EXPECT_TRUE(c.led.asserted());
  EXPECT_EQ(c.led.changes().total(), before) << "steady while it tracks";
  c.SendCommand(CommandCode::kCalibrateNeutral);
  c.For(milliseconds(900));
  EXPECT_GE(c.led.changes().total(), before + 5) << "three flashes";
}

}  // namespace
}  // namespace facewire::app
