// The emergency stop that outlasts the process, and what else a service says about its storage: the
// service on fakes, its latch on a disk that fails on demand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/app/fake_disk.h"
#include "tests/app/performer.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using wire::CommandCode;
using wire::CommandResult;
using S = ServiceState;

class Stop : public testing::Test, public ServiceContext {
 public:
  // What a crash, kill -9 or a restart leaves: the disk.
  void Restart() {
    service.reset();
    poses.clear();
    answers.clear();
    latch.emplace(std::vector<std::string>{"/var", "/run"}, disk);
    Begin();
  }
  bool OnDisk(const char* path) const { return disk.Seen().contains(path); }

  FakeDisk disk;
};

TEST_F(Stop, HoldsAfterARestartUntilItIsReleased) {
  Restart();
  BringToTracking();
  SendCommand(CommandCode::kStop);
  Tick();
  EXPECT_EQ(last_pose.state, S::kStopped) << "within one tick";
  EXPECT_TRUE(OnDisk("/var/stopped"));
  Tick();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].result, CommandResult::kOk);

  Restart();
  For(seconds(5));
  for (const wire::Pose& pose : poses) ASSERT_EQ(pose.state, S::kStopped) << "from the first";
  EXPECT_STREQ(service->reason(), "remembered from before the start");

  SendCommand(CommandCode::kRelease);
  For(seconds(1));
  EXPECT_EQ(last_pose.state, S::kTracking);
  EXPECT_FALSE(OnDisk("/var/stopped"));
  Restart();
  Tick();
  EXPECT_EQ(last_pose.state, S::kStarting) << "released is released";
}

TEST_F(Stop, OfTheStopLineIsRememberedToo) {
  Restart();
  BringToTracking();
  stop.Hold(true);
  Tick();
  EXPECT_EQ(last_pose.state, S::kStopped);
  EXPECT_TRUE(OnDisk("/var/stopped"));
  SendCommand(CommandCode::kRelease);
  For(milliseconds(100));
  EXPECT_EQ(answers.at(0).result, CommandResult::kRefused);
  EXPECT_TRUE(OnDisk("/var/stopped"));
}

TEST_F(Stop, ThatComesWithItsReleaseIsRememberedAgain) {
  Restart();
  BringToTracking();
  SendCommand(CommandCode::kStop, 1);
  Tick();
  SendCommand(CommandCode::kRelease, 2);
  SendCommand(CommandCode::kStop, 3);
  For(milliseconds(100));
  EXPECT_EQ(last_pose.state, S::kStopped);
  EXPECT_TRUE(OnDisk("/var/stopped"));
}

TEST_F(Stop, OnAReadOnlyDiskStopsAllTheSameAndSaysSo) {
  Restart();
  BringToTracking();
  disk.ReadOnly();
  SendCommand(CommandCode::kStop);
  Tick();
  EXPECT_EQ(last_pose.state, S::kStopped);
  Tick();
  EXPECT_EQ(answers.at(0).result, CommandResult::kNotKept);
  EXPECT_THAT(latch->reason(), testing::HasSubstr("Read-only file system"));
  const int calls = disk.calls();
  For(seconds(1));
  EXPECT_EQ(disk.calls(), calls) << "it does not try again in every tick";

  disk.Repair();
  SendCommand(CommandCode::kStop, 8);
  For(milliseconds(100));
  EXPECT_EQ(answers.at(1).result, CommandResult::kOk) << "but when somebody stops again";
  EXPECT_TRUE(OnDisk("/var/stopped"));
}

TEST_F(Stop, IsNotReleasedWhileItCannotBeForgotten) {
  disk.Hold("/var/stopped", "");
  Restart();
  disk.ReadOnly();
  SendCommand(CommandCode::kRelease, 1);
  For(milliseconds(500));
  EXPECT_EQ(answers.at(0).result, CommandResult::kFailed);
  EXPECT_EQ(last_pose.state, S::kStopped) << "the next boot would stop it again";
  disk.Repair();
  SendCommand(CommandCode::kRelease, 2);
  For(seconds(1));
  EXPECT_EQ(answers.at(1).result, CommandResult::kOk);
  EXPECT_NE(last_pose.state, S::kStopped);
}

TEST_F(Stop, HoldsOverAReload) {
  disk.Hold("/run/stopped", "");
  Restart();
  Tick();
  ASSERT_TRUE(service->Reload(config, character));
  For(seconds(1));
  EXPECT_EQ(last_pose.state, S::kStopped);
}

TEST_F(Stop, LeavesErrandsToItsOwnerAndRefusesThemToTheLine) {
  Restart();
  SendCommand(CommandCode::kReport, 1);
  SendCommand(CommandCode::kReload, 2);
  For(milliseconds(100));
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].result, CommandResult::kRefused);
  EXPECT_EQ(answers[1].result, CommandResult::kRefused);
  EXPECT_FALSE(service->NextErrand());
}

TEST(Ailment, IsALineThatIsOpenButTakesNothing) {
  ServiceContext c;
  c.BringToTracking();
  c.port.AcceptOnly(0);
  c.For(seconds(9));
  EXPECT_STREQ(c.service->Ailment(), "");
  c.For(seconds(2));
  EXPECT_STREQ(c.service->Ailment(), "the line is open but takes no bytes");
  c.port.AcceptAll();
  c.For(seconds(1));
  EXPECT_STREQ(c.service->Ailment(), "");
}

TEST(Ailment, IsNoLineThatIsUnplugged) {
  ServiceContext c;
  c.BringToTracking();
  c.port.Unplug();
  c.For(seconds(30));
  EXPECT_EQ(c.service->state(), S::kFault);
  EXPECT_STREQ(c.service->reason(), "the line to the host is gone");
  EXPECT_STREQ(c.service->Ailment(), "");
}

TEST(Ailment, OfALineIsIgnoredWhenAHostMayBeOff) {
  ServiceContext c;
  c.config.line_stuck_after = {};
  c.BringToTracking();
  c.port.AcceptOnly(0);
  c.For(seconds(60));
  EXPECT_STREQ(c.service->Ailment(), "");
}

TEST(Ailment, IsNoneWhileNobodyIsThere) {
  ServiceContext c;
  c.For(seconds(60));
  EXPECT_EQ(c.service->state(), S::kResting);
  EXPECT_STREQ(c.service->Ailment(), "") << "a search that finds nobody is healthy";
}

TEST(KeepNeutral, SaysThatItLastsOnlyUntilTheRestart) {
  ServiceContext c;
  c.follower.face = StillPerformer();
  c.why_not_kept = "/var/lib/facewire: Read-only file system";
  c.BringToTracking();
  c.SendCommand(CommandCode::kCalibrateNeutral);
  c.For(seconds(3));
  ASSERT_EQ(c.answers.size(), 1U);
  EXPECT_EQ(c.answers[0].result, CommandResult::kNotKept);
  EXPECT_EQ(c.service->neutral_kind(), Service::NeutralKind::kNotKept);
  c.why_not_kept = "";
  c.SendCommand(CommandCode::kCalibrateNeutral, 8);
  c.For(seconds(3));
  EXPECT_EQ(c.answers.at(1).result, CommandResult::kOk);
  EXPECT_EQ(c.service->neutral_kind(), Service::NeutralKind::kKept);
}

}  // namespace
}  // namespace facewire::app
