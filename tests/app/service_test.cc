#include "app/service.h"

#include <gtest/gtest.h>

#include "tests/app/performer.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using S = ServiceState;
using wire::CommandCode;
using wire::CommandResult;

TEST(Service, DescribesTheRigAndStartsWithNeutralFrames) {
  ServiceContext c;
  c.follower.failure.reset();
  for (int i = 0; i < 5; ++i) {
    c.Tick();
    EXPECT_EQ(c.last_pose.state, S::kStarting) << i;
  }
  ASSERT_TRUE(c.host_rig.Complete());
  EXPECT_EQ(c.host_rig.rig().name.view(), "small");
  EXPECT_EQ(c.host_rig.rig_id(), c.last_pose.rig_id);
  EXPECT_NEAR(c.Jaw(), 1, 1e-3) << "neutral, though there is a face";
}

TEST(Service, FollowsAFace) {
  ServiceContext c;
  c.BringToTracking();
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  EXPECT_NEAR(c.Jaw(), 10, 1e-3);
  EXPECT_EQ(c.service->stats().frames_dropped, 0U);
  EXPECT_GT(c.service->stats().faces, 10U);
}

TEST(Service, NeverSendsAValueOutsideTheLimitsWhateverIsSeen) {
  ServiceContext c;
  c.BringToTracking();
  for (const float jaw : {1e30F, -1e30F, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(), 3.0F}) {
    c.follower.jaw = jaw;
    for (int i = 0; i < 10; ++i) {
      c.Tick();
      EXPECT_GE(c.Jaw(), -5);
      EXPECT_LE(c.Jaw(), 20);
    }
  }
  EXPECT_NEAR(c.Jaw(), 3, 1e-3) << "and recovers";
}

TEST(Service, HoldsThenEasesThenRestsWhenTheFaceIsLost) {
  ServiceContext c;
  c.BringToTracking();
  c.follower.failure = Errc::kNoFace;
  c.For(milliseconds(200));
  EXPECT_EQ(c.last_pose.state, S::kHolding);
  EXPECT_NEAR(c.Jaw(), 10, 1e-3);
  c.For(milliseconds(300));
  EXPECT_EQ(c.last_pose.state, S::kEasing);
  c.For(milliseconds(600));
  EXPECT_EQ(c.last_pose.state, S::kSearching);
  EXPECT_NEAR(c.Jaw(), 1, 1e-3);
  c.For(seconds(6));
  EXPECT_EQ(c.last_pose.state, S::kResting);
  EXPECT_EQ(c.service->stats().losses, 1U);
}

TEST(Service, CountsRejectedFacesApart) {
  ServiceContext c;
  c.BringToTracking();
  c.follower.failure = Errc::kRejected;
  c.For(milliseconds(100));
  EXPECT_EQ(c.last_pose.state, S::kHolding);
  EXPECT_GE(c.service->stats().rejected, 2U);
}

TEST(Service, SendsPosesAtTwentyHertzAtLeastWhileTheCameraIsSilent) {
  ServiceContext c;
  c.BringToTracking();
  c.camera.FallSilent();
  const std::size_t before = c.poses.size();
  c.For(seconds(4));
  EXPECT_GE(c.poses.size() - before, 79U);
  for (std::size_t i = before; i < c.poses.size(); ++i) {
    EXPECT_LE(c.pose_times[i] - c.pose_times[i - 1], milliseconds(51)) << i;
  }
  EXPECT_EQ(c.last_pose.state, S::kFault);
  EXPECT_NEAR(c.Jaw(), 1, 1e-3);
}

TEST(Service, RestartsASilentCameraAndRecovers) {
  ServiceContext c;
  c.BringToTracking();
  c.camera.FallSilent();
  EXPECT_STREQ(c.service->Ailment(), "");
  c.For(seconds(10));
  const std::uint64_t restarts = c.service->stats().camera_restarts;
  EXPECT_GE(restarts, 2U);
  EXPECT_LE(restarts, 10U) << "with back-off";
  EXPECT_STRNE(c.service->Ailment(), "")
      << "it opens, but nothing comes: somebody should restart us";
  EXPECT_GE(c.follower.forgotten, 1);
  c.camera.Resume();
  c.For(seconds(9));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  EXPECT_STREQ(c.service->Ailment(), "");
}

TEST(Service, CountsDamagedPicturesOverRestartsOfTheCamera) {
  ServiceContext c;
  c.BringToTracking();
  c.camera.Damage(3);
  c.For(milliseconds(100));
  EXPECT_EQ(c.service->stats().frames_damaged, 3U);
  c.camera.Unplug();
  c.For(seconds(1));
  c.camera.Plug();
  c.For(seconds(9));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  c.camera.Damage(2);
  c.For(milliseconds(100));
  EXPECT_EQ(c.service->stats().frames_damaged, 5U);
}

TEST(Service, RecoversWhenTheCameraIsReplugged) {
  ServiceContext c;
  c.BringToTracking();
  c.camera.Unplug();
  c.For(seconds(5));
  EXPECT_EQ(c.last_pose.state, S::kFault);
  EXPECT_STREQ(c.service->Ailment(), "") << "unplugged is a known state, no reason to restart";
  c.camera.Plug();
  c.For(seconds(9));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  EXPECT_NEAR(c.Jaw(), 10, 1e-3);
}

TEST(Service, EndsCleanlyAtNeutralWhenARecordingEnds) {
  ServiceContext c;
  c.BringToTracking();
  c.camera.End();
  c.For(seconds(5));
  EXPECT_FALSE(c.alive);
  EXPECT_NEAR(c.Jaw(), 1, 1e-3);
}

TEST(Service, EasesToNeutralBeforeItQuits) {
  ServiceContext c;
  c.BringToTracking();
  c.service->Quit();
  const std::size_t before = c.poses.size();
  c.For(seconds(5));
  EXPECT_FALSE(c.alive);
  ASSERT_GE(c.poses.size() - before, 5U);
  for (std::size_t i = c.poses.size() - 5; i < c.poses.size(); ++i) {
    EXPECT_NEAR(wire::ValuesOf(c.poses[i], c.host_rig.rig()).values[0], 1, 1e-3);
  }
}

TEST(Service, LatchesAnEmergencyStopOfTheHostUntilItIsReleased) {
  ServiceContext c;
  c.BringToTracking();
  c.SendCommand(CommandCode::kStop);
  c.Tick();
  EXPECT_EQ(c.last_pose.state, S::kStopped);
  c.follower.jaw = 18;
  c.For(seconds(3));
  EXPECT_EQ(c.last_pose.state, S::kStopped);
  EXPECT_NEAR(c.Jaw(), 10, 1e-3) << "frozen";
  c.SendCommand(CommandCode::kRelease, 8);
  c.Tick();
  EXPECT_EQ(c.last_pose.state, S::kStarting);
  c.For(seconds(1));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  ASSERT_EQ(c.answers.size(), 2U);
  EXPECT_EQ(c.answers[0].code, CommandCode::kStop);
  EXPECT_EQ(c.answers[0].result, CommandResult::kOk);
  EXPECT_EQ(c.answers[1].id, 8);
}

TEST(Service, StopsWhenTheStopLineIsAssertedOrUnreadable) {
  for (const bool broken : {false, true}) {
    ServiceContext c;
    c.BringToTracking();
    if (broken) {
      c.stop.Break(Errc::kIo);
    } else {
      c.stop.Hold(true);
    }
    c.Tick();
    EXPECT_EQ(c.last_pose.state, S::kStopped) << broken;
    c.SendCommand(CommandCode::kRelease);
    c.For(milliseconds(200));
    EXPECT_EQ(c.last_pose.state, S::kStopped) << "still asserted";
    ASSERT_EQ(c.answers.size(), 1U);
    EXPECT_EQ(c.answers[0].result, CommandResult::kRefused);
    c.stop.Repair();
    c.stop.Hold(false);
    c.For(milliseconds(200));
    EXPECT_EQ(c.last_pose.state, S::kStopped) << "latched";
    c.SendCommand(CommandCode::kRelease);
    c.Tick();
    EXPECT_EQ(c.last_pose.state, S::kStarting);
  }
}

TEST(Service, RestsOnCommandUntilReleased) {
  ServiceContext c;
  c.BringToTracking();
  c.SendCommand(CommandCode::kRest);
  c.For(seconds(1));
  EXPECT_EQ(c.last_pose.state, S::kSearching);
  EXPECT_NEAR(c.Jaw(), 1, 1e-3);
  c.SendCommand(CommandCode::kRelease);
  c.For(milliseconds(500));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
}

TEST(Service, AnswersPingDescribeAndUnknownCommands) {
  ServiceContext c;
  c.For(seconds(1));
  c.SendCommand(CommandCode::kPing, 1);
  c.SendCommand(CommandCode::kDescribeRig, 2);
  c.SendCommand(static_cast<CommandCode>(99), 3);
  c.host_rig = {};
  c.For(milliseconds(300));
  ASSERT_EQ(c.answers.size(), 3U);
  EXPECT_EQ(c.answers[0].result, CommandResult::kOk);
  EXPECT_EQ(c.answers[2].id, 3);
  EXPECT_EQ(c.answers[2].result, CommandResult::kUnknown);
  EXPECT_TRUE(c.host_rig.Complete()) << "described again";
}

TEST(Service, DescribesTheRigEveryFewSecondsForHostsThatJoinLater) {
  ServiceContext c;
  c.For(seconds(3));
  c.host_rig = {};
  c.For(seconds(3));
  EXPECT_TRUE(c.host_rig.Complete());
}

TEST(Service, SendsAStatusOnceASecond) {
  ServiceContext c;
  c.For(seconds(4));
  EXPECT_GE(c.statuses.size(), 4U);
  EXPECT_LE(c.statuses.size(), 5U);
  EXPECT_NEAR(c.statuses.back().centi_fps, 3000, 110);
  EXPECT_EQ(c.statuses.back().state, S::kSearching);
}

TEST(Service, ReopensALineThatWasUnpluggedAndStartsOver) {
  ServiceContext c;
  c.BringToTracking();
  c.port.Unplug();
  c.For(seconds(3));
  EXPECT_EQ(c.service->state(), S::kFault);
  EXPECT_EQ(c.line.counters().hang_ups, 1U);
  c.host_rig = {};
  c.port.Plug();
  c.poses.clear();
  c.For(seconds(9));
  ASSERT_FALSE(c.poses.empty());
  EXPECT_NE(c.poses.front().state, S::kTracking) << "from neutral, with a ramp";
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  EXPECT_TRUE(c.host_rig.Complete()) << "a new listener gets the description";
  EXPECT_EQ(c.line.counters().opens, 2U);
}

TEST(Service, NeverSendsHalfAFrameWhenTheLineIsFull) {
  ServiceContext c;
  c.BringToTracking();
  c.port.AcceptOnly(10);  // in the middle of a frame
  c.For(milliseconds(500));
  EXPECT_GE(c.line.counters().poses_dropped, 5U);
  c.port.AcceptAll();
  c.For(seconds(1));
  EXPECT_EQ(c.host_decoder.stats().Damaged(), 0U);
  EXPECT_EQ(c.last_pose.state, S::kTracking);
}

TEST(Service, KeepsItsRateWhenTheLineTakesNothing) {
  ServiceContext c;
  c.BringToTracking();
  c.port.AcceptOnly(0);
  const std::uint64_t before = c.service->stats().frames;
  c.For(seconds(2));
  EXPECT_GE(c.service->stats().frames - before, 59U);
  c.port.AcceptAll();
  c.For(seconds(1));
  EXPECT_GE(c.host_decoder.stats().lost, 59U) << "the host can tell from the numbers";
  EXPECT_EQ(c.host_decoder.stats().Damaged(), 0U);
}

TEST(Service, GoesOnWithoutALine) {
  ServiceContext c;
  HostLine none(nullptr, c.clock, milliseconds(5));
  Service service(c.config,
                  {.camera = c.camera,
                   .line = none,
                   .clock = c.clock,
                   .follower = c.follower,
                   .capture = c.capture},
                  c.character);
  c.follower.failure.reset();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(service.Tick());
  EXPECT_EQ(service.state(), S::kTracking);
  EXPECT_EQ(c.port.written().total(), 0U);
}

TEST(Service, CountsBlinks) {
  ServiceContext c;
  c.BringToTracking();
  for (int blink = 0; blink < 5; ++blink) {
    c.follower.blink = 0.9F;
    c.For(milliseconds(150));
    c.follower.blink = 0.45F;  // trembles around half: still the same blink
    c.For(milliseconds(100));
    c.follower.blink = 0.6F;
    c.For(milliseconds(100));
    c.follower.blink = 0;
    c.For(milliseconds(300));
  }
  EXPECT_EQ(c.service->stats().blinks.count(), 5U);
}

TEST(Service, AnswersCalibrationWithoutAFaceAtOnce) {
  ServiceContext c;
  c.For(seconds(1));
  c.SendCommand(CommandCode::kCalibrateNeutral);
  c.For(milliseconds(100));
  ASSERT_EQ(c.answers.size(), 1U);
  EXPECT_EQ(c.answers[0].result, CommandResult::kNoFace);
  EXPECT_EQ(c.kept, 0);
}

TEST(Service, AnswersCalibrationWithNoFaceWhenTheFaceGoesMeanwhile) {
  ServiceContext c;
  c.BringToTracking();
  c.SendCommand(CommandCode::kCalibrateNeutral);
  c.For(milliseconds(300));
  EXPECT_TRUE(c.answers.empty()) << "it takes a second";
  c.SendCommand(CommandCode::kCalibrateNeutral, 8);
  c.For(milliseconds(100));
  ASSERT_EQ(c.answers.size(), 1U);
  EXPECT_EQ(c.answers[0].id, 8);
  EXPECT_EQ(c.answers[0].result, CommandResult::kRefused) << "one at a time";
  c.follower.failure = Errc::kNoFace;
  c.For(milliseconds(100));
  ASSERT_EQ(c.answers.size(), 2U);
  EXPECT_EQ(c.answers[1].id, 7);
  EXPECT_EQ(c.answers[1].result, CommandResult::kNoFace);
}

TEST(Service, AnswersACalibrationAlthoughTheCameraFellSilent) {
  ServiceContext c;
  c.BringToTracking();
  c.SendCommand(CommandCode::kCalibrateNeutral);
  c.For(milliseconds(100));
  c.camera.FallSilent();
  c.For(seconds(11));
  ASSERT_EQ(c.answers.size(), 1U);
  EXPECT_NE(c.answers[0].result, CommandResult::kOk);
}

TEST(Service, BlendsThePersonalProfileIn) {
  ServiceContext c;
  c.GivePersonalProfile();
  c.SendCommand(CommandCode::kBlendProfile, 1, 0.25F);
  c.For(milliseconds(100));
  EXPECT_EQ(c.character.retargeter.blend(), 0.25F);
  c.SendCommand(CommandCode::kBlendProfile, 2, 1.01F);
  c.SendCommand(CommandCode::kBlendProfile, 3, -0.01F);
  c.For(milliseconds(100));
  EXPECT_EQ(c.character.retargeter.blend(), 0.25F) << "unchanged";
  ASSERT_EQ(c.answers.size(), 3U);
  EXPECT_EQ(c.answers[0].result, CommandResult::kOk);
  EXPECT_EQ(c.answers[1].result, CommandResult::kRefused);
  EXPECT_EQ(c.answers[2].result, CommandResult::kRefused);
}

TEST(Service, RefusesToBlendAPersonalProfileThatThereIsNot) {
  ServiceContext c;
  c.SendCommand(CommandCode::kBlendProfile, 1, 0.25F);
  c.For(milliseconds(100));
  ASSERT_EQ(c.answers.size(), 1U);
  EXPECT_EQ(c.answers[0].result, CommandResult::kRefused);
}

// What a hand does to the button, with the pictures' own time.
void PressButton(ServiceContext& c, Duration time) {
  c.button.Hold(true);
  c.For(time);
  c.button.Hold(false);
  c.For(milliseconds(200));
}

TEST(Service, CalibratesAtAShortPressOfTheButton) {
  ServiceContext c;
  c.follower.face = StillPerformer();
  c.BringToTracking();
  PressButton(c, milliseconds(300));
  EXPECT_TRUE(c.logged.empty()) << "it takes a second";
  c.For(seconds(2));
  ASSERT_EQ(c.logged.size(), 1U);
  EXPECT_EQ(c.logged[0].code, CommandCode::kCalibrateNeutral);
  EXPECT_EQ(c.logged[0].result, CommandResult::kOk);
  EXPECT_EQ(c.kept, 1);
  EXPECT_TRUE(c.answers.empty()) << "the host did not ask";
}

TEST(Service, ReleasesAnEmergencyStopAtALongPressOfTheButtonAndNotAtAShortOne) {
  ServiceContext c;
  c.BringToTracking();
  c.SendCommand(CommandCode::kStop);
  c.Tick();
  PressButton(c, milliseconds(1000));
  EXPECT_EQ(c.last_pose.state, S::kStopped);
  PressButton(c, milliseconds(2200));
  c.For(seconds(1));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  ASSERT_EQ(c.logged.size(), 2U);
  EXPECT_EQ(c.logged[0].result, CommandResult::kNoFace) << "nothing is calibrated in a stop";
  EXPECT_EQ(c.logged[1].code, CommandCode::kRelease);
}

TEST(Service, TheButtonReleasesNothingWhileTheStopSwitchIsOnOrTheButtonIsStuckOrBroken) {
  ServiceContext c;
  c.button.Hold(true);  // from the beginning
  c.BringToTracking();
  c.SendCommand(CommandCode::kStop);
  c.For(seconds(4));
  EXPECT_EQ(c.last_pose.state, S::kStopped);
  c.button.Hold(false);
  c.For(milliseconds(200));
  c.button.Break(Errc::kIo);
  c.For(seconds(4));
  c.button.Repair();
  c.For(milliseconds(200));
  EXPECT_TRUE(c.logged.empty());
  c.stop.Hold(true);
  PressButton(c, milliseconds(2500));
  c.stop.Hold(false);
  c.For(seconds(1));
  EXPECT_EQ(c.last_pose.state, S::kStopped);
  ASSERT_EQ(c.logged.size(), 1U);
  EXPECT_EQ(c.logged[0].result, CommandResult::kRefused);
}

TEST(Service, GoesOnWithAnotherRigAfterAReload) {
  ServiceContext c;
  c.BringToTracking();
  Rig rig = SmallRig();
  rig.channels[0].max = 8;
  Character other;
  c.Configure(other, rig);
  c.host_rig = {};
  ASSERT_TRUE(c.service->Reload(c.config, other));
  c.For(milliseconds(60));
  EXPECT_EQ(c.last_pose.rig_id, other.rig_id);
  EXPECT_EQ(c.last_pose.state, S::kStarting);
  c.For(seconds(1));
  ASSERT_TRUE(c.host_rig.Complete());
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  EXPECT_NEAR(c.Jaw(), 8, 1e-3) << "the new limit";
}

TEST(Service, KeepsRunningAsItWasAfterAReloadThatFails) {
  ServiceContext c;
  c.BringToTracking();
  Rig rig = SmallRig();
  rig.channels[0].min = 30;  // above max
  Character other;
  c.Configure(other, rig);
  EXPECT_FALSE(c.service->Reload(c.config, other));
  c.For(milliseconds(100));
  EXPECT_EQ(c.last_pose.state, S::kTracking);
  EXPECT_EQ(c.last_pose.rig_id, c.character.rig_id);
}

TEST(Service, PlaysARecordingByItsOwnTimeWhenItIsAsFastAsPossible) {
  ServiceContext c;
  hal::fake::FakeCamera fast({.pictures = std::span(&c.picture, 1), .pace = hal::Pace::kFast},
                             c.clock);
  ASSERT_TRUE(fast.Start());
  ServiceConfig config = c.config;
  config.media_time = true;
  Service service(config,
                  {.camera = fast,
                   .line = c.line,
                   .clock = c.clock,
                   .follower = c.follower,
                   .capture = c.capture},
                  c.character);
  c.follower.failure.reset();
  const Time before = c.clock.Now();
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(service.Tick());
  EXPECT_EQ(c.clock.Now(), before) << "nothing waits";
  EXPECT_EQ(service.state(), S::kTracking) << "two seconds of the recording";
  fast.End();
  int ticks = 0;
  while (service.Tick()) ASSERT_LT(++ticks, 100);
  EXPECT_EQ(c.clock.Now(), before);
}

TEST(LatencyHistogram, TellsQuantiles) {
  LatencyHistogram h;
  EXPECT_EQ(h.Quantile(0.5), Duration{});
  for (int i = 1; i <= 100; ++i) h.Add(milliseconds(i));
  EXPECT_NEAR(static_cast<double>(h.Quantile(0.5).count()), 50'000, 300);
  EXPECT_NEAR(static_cast<double>(h.Quantile(0.99).count()), 99'000, 300);
  h.Add(seconds(100));
  EXPECT_EQ(h.Quantile(1), LatencyHistogram::kStep * LatencyHistogram::kSteps) << "the last step";
  h.Add(-seconds(1));
  EXPECT_EQ(h.Quantile(0), LatencyHistogram::kStep);
}

}  // namespace
}  // namespace facewire::app
