#include "core/animatronic/animatronic.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <vector>

namespace facewire::animatronic {
namespace {

using std::chrono::milliseconds;

// A bus that obeys at once, and says what the test wants to hear.
class FakeBus final : public bus::ServoBus {
 public:
  explicit FakeBus(std::size_t servos, bool reads_back = true) : reads_back_(reads_back) {
    (void)feedback_.try_resize(servos);
    for (bus::ServoFeedback& said : feedback_) said.state = bus::ServoState::kLimp;
  }

  void Receive(std::span<const std::byte> bytes, Time) noexcept override {
    received.insert(received.end(), bytes.begin(), bytes.end());
  }
  std::span<const std::byte> Tick(Time now,
                                  std::span<const bus::ServoCommand> commands) noexcept override {
    ticks.push_back(now);
    told.assign(commands.begin(), commands.end());
    for (std::size_t i = 0; i < commands.size(); ++i) feedback_[i].torque = commands[i].torque;
    return std::span(kWord).first(1);
  }
  std::span<const std::byte> Release(Time) noexcept override {
    ++releases;
    for (bus::ServoFeedback& said : feedback_) said.torque = false;
    return kWord;
  }
  void Restart() noexcept override { ++restarts; }
  Result<> Reboot(std::size_t servo) noexcept override {
    rebooted = servo;
    return {};
  }
  std::span<const bus::ServoFeedback> feedback() const noexcept override {
    return feedback_.span();
  }
  const bus::BusStatus& status() const noexcept override { return status_; }
  bus::BusTraits traits() const noexcept override { return {.step = 1, .reads_back = reads_back_}; }

  void Say(std::size_t servo, float position, Time now) {
    feedback_[servo].position = position;
    feedback_[servo].position_read = now;
  }
  void SayHealth(std::size_t servo, float factor) { feedback_[servo].factor = factor; }

  std::vector<Time> ticks;
  std::vector<bus::ServoCommand> told;
  std::vector<std::byte> received;
  int releases = 0;
  int restarts = 0;
  std::optional<std::size_t> rebooted;

 private:
  static constexpr std::array<std::byte, 2> kWord{};
  bool reads_back_;
  InlineVector<bus::ServoFeedback, kMaxServos> feedback_;
  bus::BusStatus status_;
};

servo::Servo AServo(std::uint8_t id, const char* bus) {
  servo::Servo servo;
  servo.name = *ShortName::From(std::string("servo_") + bus + std::to_string(id));
  servo.bus = *ShortName::From(bus);
  servo.id = id;
  servo.min = 1000;
  servo.neutral = 1500;
  servo.max = 2000;
  servo.max_speed_per_s = 1000;
  servo.max_acceleration_per_s2 = 20000;
  servo.crawl_speed_per_s = 100;
  return servo;
}

// Two buses: servos 0 and 2 of the rig hang on the first one, servo 1 on the second.
class AnimatronicTest : public ::testing::Test {
 protected:
  AnimatronicTest() {
    for (const auto& servo : {AServo(1, "a"), AServo(1, "b"), AServo(2, "a")}) {
      (void)rig.servos.try_push(servo);
    }
    Attachment& first = attachments.emplace_back();
    first.driver = &a;
    (void)first.servos.try_push(0);
    (void)first.servos.try_push(2);
    Attachment& second = attachments.emplace_back();
    second.driver = &b;
    second.period = milliseconds(20);
    (void)second.servos.try_push(1);
  }

  void Configure() { ASSERT_TRUE(head.Configure(rig, attachments)); }
  void Wish(float position) {
    servo::Wishes wishes;
    wishes.count = rig.servos.size();
    wishes.captured = now;
    wishes.positions.fill(position);
    head.Take(wishes, now);
  }
  std::vector<std::size_t> Tick() {
    head.Update(now);
    std::vector<std::size_t> bytes;
    for (std::size_t i = 0; i < head.buses(); ++i) bytes.push_back(head.Bytes(i, now).size());
    now += head.period();
    return bytes;
  }
  void SayAll(float position) {
    a.Say(0, position, now);
    a.Say(1, position, now);
    b.Say(0, position, now);
  }
  void Run(Duration time, float wish, float reading) {
    for (const Time end = now + time; now < end;) {
      SayAll(reading);
      Wish(wish);
      Tick();
    }
  }

  FakeBus a{2}, b{1};
  servo::ServoRig rig;
  std::vector<Attachment> attachments;
  Animatronic head;
  Time now{milliseconds(1000)};
};

TEST_F(AnimatronicTest, TicksAtTheRateOfTheFastestBusAndEachBusAtItsOwn) {
  Configure();
  EXPECT_EQ(head.period(), milliseconds(10));
  for (int i = 0; i < 10; ++i) Tick();
  EXPECT_EQ(a.ticks.size(), 10U);
  EXPECT_EQ(b.ticks.size(), 5U);
}

TEST_F(AnimatronicTest, ALateTickDoesNotMoveTheNext) {
  Configure();
  Tick();
  now += milliseconds(13);  // at 23 ms: the turn of 20 ms
  Tick();
  now += milliseconds(7);  // at 40 ms
  Tick();
  ASSERT_EQ(b.ticks.size(), 3U);
  EXPECT_EQ(b.ticks[2] - b.ticks[0], milliseconds(40));
}

TEST_F(AnimatronicTest, ATickThatIsEarlierThanALateOneMissesNoTurn) {
  Configure();
  const Time start = now;
  for (int i = 0; i < 100; ++i) {
    now = start + i * milliseconds(10) + std::chrono::microseconds(i % 3 == 0 ? 900 : 50);
    head.Update(now);
    for (std::size_t bus = 0; bus < head.buses(); ++bus) (void)head.Bytes(bus, now);
  }
  EXPECT_EQ(a.ticks.size(), 100U);
  EXPECT_EQ(b.ticks.size(), 50U);
}

TEST_F(AnimatronicTest, TellsEveryServoOnItsOwnBus) {
  Configure();
  a.Say(0, 1100, now);
  a.Say(1, 1200, now);
  b.Say(0, 1300, now);
  Wish(1500);
  Tick();
  ASSERT_EQ(a.told.size(), 2U);
  ASSERT_EQ(b.told.size(), 1U);
  EXPECT_EQ(a.told[0].position, 1100);
  EXPECT_EQ(a.told[1].position, 1200);
  EXPECT_EQ(b.told[0].position, 1300);
}

TEST_F(AnimatronicTest, MotionBeginsWhereAServoWasReadAndWaitsForThat) {
  Configure();
  a.Say(0, 1100, now);
  for (int i = 0; i < 20; ++i) {
    Wish(1500);
    Tick();
  }
  EXPECT_TRUE(a.told[0].torque);
  EXPECT_GE(a.told[0].position, 1100);
  EXPECT_LT(a.told[0].position, 1130);  // crawls
  EXPECT_FALSE(a.told[1].torque);       // was never read
}

TEST_F(AnimatronicTest, AnOldPositionIsNotANewReading) {
  Configure();
  SayAll(1100);
  now += milliseconds(1500);
  Tick();  // passes them on late, and once
  now += milliseconds(1500);
  Wish(1500);
  Tick();
  EXPECT_FALSE(a.told[0].torque);
}

TEST_F(AnimatronicTest, AControllerThatWasFoundPulsingGoesOnFromThatPulse) {
  FakeBus maestro(2, /*reads_back=*/false);
  attachments[0].driver = &maestro;
  Configure();
  maestro.Say(0, 1750, now);
  b.Say(0, 1500, now);
  Wish(1500);
  Tick();
  EXPECT_EQ(maestro.told[0].position, 1750);
  EXPECT_TRUE(maestro.told[0].torque);
  EXPECT_EQ(maestro.told[1].position, 1500);  // nobody knows: its neutral
}

TEST_F(AnimatronicTest, AServoThatIsNotWellSlowsDownAndThenLetsGo) {
  Configure();
  Run(milliseconds(2000), 1500, 1500);
  a.SayHealth(0, 0);
  Run(milliseconds(100), 1600, 1500);
  EXPECT_FALSE(a.told[0].torque);
  EXPECT_TRUE(a.told[1].torque);
  EXPECT_EQ(head.commands().servos[0].activity, servo::Activity::kHot);
}

TEST_F(AnimatronicTest, AStopReleasesEveryBusWithItsNextBytes) {
  Configure();
  Run(milliseconds(2000), 1500, 1500);
  head.Stop();
  EXPECT_EQ(Tick(), (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(a.releases, 1);
  EXPECT_EQ(b.releases, 1);
  Run(milliseconds(100), 1600, 1500);
  EXPECT_EQ(a.releases, 1);  // the drivers see to the rest
  EXPECT_FALSE(a.told[0].torque);
  EXPECT_TRUE(head.Limp());
}

TEST_F(AnimatronicTest, AStopWithTorqueReleasesWhenItsTimeIsOver) {
  rig.contract.stop_torque = milliseconds(500);
  Configure();
  Run(milliseconds(2000), 1500, 1500);
  head.Stop();
  Run(milliseconds(400), 1600, 1500);
  EXPECT_EQ(a.releases, 0);
  EXPECT_EQ(a.told[0].position, 1500);
  EXPECT_TRUE(a.told[0].torque);
  EXPECT_TRUE(a.told[0].stop) << "what moves by itself has to be told";
  Run(milliseconds(200), 1600, 1500);
  EXPECT_EQ(a.releases, 1);
}

TEST_F(AnimatronicTest, AStopThatIsOverBeforeItsTimeReleasesNothing) {
  rig.contract.stop_torque = milliseconds(500);
  Configure();
  Run(milliseconds(2000), 1500, 1500);
  head.Stop();
  Tick();
  head.Release();
  Run(milliseconds(1000), 1500, 1500);
  EXPECT_FALSE(a.told[0].stop);
  EXPECT_EQ(a.releases, 0);
  EXPECT_TRUE(a.told[0].torque);
}

TEST_F(AnimatronicTest, LettingGoIsForGood) {
  Configure();
  Run(milliseconds(2000), 1500, 1500);
  EXPECT_FALSE(head.Limp());
  head.LetGo();
  Tick();
  EXPECT_EQ(a.releases, 1);
  EXPECT_TRUE(head.Limp());
  Run(milliseconds(100), 1600, 1500);
  EXPECT_FALSE(a.told[0].torque);
}

TEST_F(AnimatronicTest, PassesOnBytesRestartsAndReboots) {
  Configure();
  const std::array<std::byte, 3> bytes{};
  head.Receive(1, bytes, now);
  EXPECT_EQ(b.received.size(), 3U);
  head.Restart(1);
  EXPECT_EQ(b.restarts, 1);
  EXPECT_EQ(a.restarts, 0);
  EXPECT_TRUE(head.Reboot(2));
  EXPECT_EQ(a.rebooted, 1U);
  EXPECT_EQ(head.Reboot(3).error(), Errc::kOutOfRange);
}

TEST_F(AnimatronicTest, RefusesServosOnNoBusOnTwoOrOnAnotherDriver) {
  std::vector<Attachment> none;
  EXPECT_EQ(head.Configure(rig, none).error(), Errc::kInvalidArgument);
  auto twice = attachments;
  twice[1].servos[0] = 0;
  EXPECT_EQ(head.Configure(rig, twice).error(), Errc::kInvalidArgument);
  auto beyond = attachments;
  beyond[1].servos[0] = 3;
  EXPECT_EQ(head.Configure(rig, beyond).error(), Errc::kInvalidArgument);
  auto other = attachments;
  other[1].driver = &a;
  EXPECT_EQ(head.Configure(rig, other).error(), Errc::kInvalidArgument);
  auto still = attachments;
  still[0].period = Duration::zero();
  EXPECT_EQ(head.Configure(rig, still).error(), Errc::kInvalidArgument);
  EXPECT_EQ(head.buses(), 0U);
  EXPECT_EQ(head.servos(), 0U);
}

TEST_F(AnimatronicTest, AServoMayArriveAsSlowlyAsItCrawlsAndGoALittleFasterThanItIsTold) {
  rig.servos[0].neutral = 1600;
  const bus::ServoConfig config = ConfigOf(rig.servos[0], {.hot_c = 61});
  EXPECT_EQ(config.id, 1);
  EXPECT_EQ(config.min, 1000);
  EXPECT_EQ(config.max, 2000);
  EXPECT_EQ(config.neutral, 1600);
  EXPECT_FLOAT_EQ(config.arrive_speed_per_s, 100);
  EXPECT_FLOAT_EQ(config.arrive_acceleration_per_s2, 2000);
  EXPECT_FLOAT_EQ(config.top_speed_per_s, 1250);
  EXPECT_EQ(config.guard.hot_c, 61);
}

}  // namespace
}  // namespace facewire::animatronic
