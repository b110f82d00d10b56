// The service with servos on a simulated chain: what reaches them, and when they have power.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/wire/message.h"
#include "tests/app/animatronic/sim_rig.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using S = ServiceState;

// The service on fakes; the servos' thread is stepped in between, on the same clock.
class Puppet : public ServiceContext {
 public:
  Puppet() {
    servos.rig.contract.limp = milliseconds(400);
    character.servos = servos.rig;
    EXPECT_TRUE(character.mapper.Configure(servos.rig, character.rig));
    servos.Build();
    Begin(line);
  }
  void Begin(HostLine& to) {
    service.emplace(config,
                    ServiceParts{.camera = camera,
                                 .line = to,
                                 .clock = clock,
                                 .follower = follower,
                                 .capture = capture,
                                 .stop = &stop,
                                 .servo_power = &power,
                                 .servos = &*servos.thread},
                    character);
  }
  // Servos tick at 100 Hz, on a clock of their own that is kept up with the service's.
  void Run(Duration time) {
    for (const Time end = clock.Now() + time; clock.Now() < end;) {
      Tick();
      while (servos.clock.Now() < clock.Now()) servos.Tick();
    }
  }
  void Track() {
    Run(seconds(1));
    follower.failure.reset();
    Run(seconds(2));
    ASSERT_EQ(service->state(), S::kTracking);
  }

  // Of the command with this id; unknown when none came.
  wire::CommandResult ResultOf(std::uint16_t id) const {
    for (const wire::Acknowledgement& answer : answers) {
      if (answer.id == id) return answer.result;
    }
    return wire::CommandResult::kUnknown;
  }

  SimRig servos;
};

TEST(ServiceServos, FollowTheFace) {
  Puppet p;
  p.follower.jaw = 10;  // of -5 to 20: 1000 to 2000
  p.Track();
  p.Run(seconds(3));
  EXPECT_NEAR(p.servos.bus.Position(0), 1600, 12);
  p.follower.jaw = 18;
  p.Run(seconds(3));
  EXPECT_NEAR(p.servos.bus.Position(0), 1920, 12);
}

TEST(ServiceServos, AreLimpWithinOneTickOfAStop) {
  Puppet p;
  p.Track();
  p.Run(seconds(2));
  ASSERT_TRUE(p.servos.bus.TorqueOn(0));
  p.stop.Hold(true);
  p.service->Tick();
  p.servos.Tick();
  p.servos.bus.Advance(p.servos.clock.Now());
  EXPECT_FALSE(p.servos.bus.TorqueOn(0));
  EXPECT_FALSE(p.power.asserted());
}

TEST(ServiceServos, AreLeftToTheirContractWhenTheServiceRests) {
  Puppet p;
  p.Track();
  p.follower.failure = Errc::kNoFace;
  p.Run(seconds(10));
  ASSERT_EQ(p.service->state(), S::kResting);
  p.Run(seconds(3));
  EXPECT_FALSE(p.servos.bus.TorqueOn(0));
  EXPECT_FALSE(p.servos.bus.TorqueOn(1));
}

TEST(ServiceServos, HavePowerWithoutALineToAHost) {
  Puppet p;
  HostLine none(nullptr, p.clock, milliseconds(5));
  p.Begin(none);
  p.Track();
  EXPECT_TRUE(p.power.asserted());
  p.Run(seconds(3));
  EXPECT_NEAR(p.servos.bus.Position(0), 1600, 12);
}

TEST(ServiceServos, LoseTheirPowerWithTheirPortAfterTheContractsTime) {
  Puppet p;
  p.Track();
  p.Run(seconds(2));
  p.servos.end.plugged = false;
  p.Run(milliseconds(1000));
  EXPECT_TRUE(p.power.asserted()) << "the contract: 1.1 s";
  p.Run(milliseconds(400));
  EXPECT_FALSE(p.power.asserted());
  p.Run(seconds(5));
  EXPECT_FALSE(p.power.asserted());
}

TEST(ServiceServos, AreMovedByHandBeforeTheFace) {
  Puppet p;
  p.follower.jaw = 10;
  p.Track();
  p.Run(seconds(2));
  for (int i = 0; i < 30; ++i) {
    p.SendCommand(wire::CommandCode::kMoveServo, 40, 1200, 0);
    p.Run(milliseconds(100));
  }
  EXPECT_NEAR(p.servos.bus.Position(0), 1200, 12);
  EXPECT_EQ(p.ResultOf(40), wire::CommandResult::kOk);
  p.Run(seconds(3));
  EXPECT_NEAR(p.servos.bus.Position(0), 1600, 12) << "the face has it again";
  p.SendCommand(wire::CommandCode::kMoveServo, 41, 1200, 2);
  p.Run(milliseconds(100));
  EXPECT_EQ(p.ResultOf(41), wire::CommandResult::kRefused) << "there are two";
  p.stop.Hold(true);
  p.Run(milliseconds(100));
  p.SendCommand(wire::CommandCode::kMoveServo, 42, 1200, 0);
  p.Run(milliseconds(100));
  EXPECT_EQ(p.ResultOf(42), wire::CommandResult::kRefused) << "stopped";
}

TEST(ServiceServos, GetNoWordFromAThreadThatHangs) {
  Puppet p;
  p.Track();
  ASSERT_TRUE(p.power.asserted());
  p.For(milliseconds(1100));
  EXPECT_FALSE(p.power.asserted());
  EXPECT_STREQ(p.service->Ailment(), "");
  p.For(seconds(10));
  EXPECT_STREQ(p.service->Ailment(), "the servos' thread hangs");
}

}  // namespace
}  // namespace facewire::app
