// The driver and the firmware on one line, with servos behind it, in virtual time.
#include "tests/tools/firmware/firmware_bus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "core/bus/receiver_bus.h"

namespace facewire::firmware {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kServos = 12;
constexpr float kRamp = 500;  // us/s
constexpr float kTop = 5000;

// A host that ticks its driver every 10 ms, or lets the line be silent.
struct Context {
  bus::ReceiverConfig config;
  bus::ReceiverBus driver;
  FirmwareBus bus;
  std::vector<bus::ServoCommand> commands{kServos};
  Time now = Time(Duration(3'000'000));
  bool cut = false;
  bool in_limits = true;
  double fastest = 0;  // of all pulses, us from one to the next
  std::vector<double> last = std::vector<double>(kServos, 0);

  explicit Context(const FirmwareBusOptions& options = {}) : bus(options) {
    for (std::uint8_t id = 0; id < kServos; ++id) {
      (void)config.bus.servos.try_push({.id = id,
                                        .min = 1000,
                                        .max = 2000,
                                        .neutral = 1500,
                                        .arrive_speed_per_s = kRamp,
                                        .arrive_acceleration_per_s2 = 2000,
                                        .top_speed_per_s = kTop});
    }
    config.bus.baud = 115'200;
    config.hold = milliseconds(200);
    config.ease = milliseconds(400);
    config.release = milliseconds(300);
    EXPECT_TRUE(driver.Configure(config));
    bus.Advance(now);
  }
  void All(float position, bool torque = true) {
    for (bus::ServoCommand& c : commands) c = {.position = position, .torque = torque};
  }
  void Pass(Duration time) {
    for (const Time end = now + time; now < end;) {
      now += milliseconds(1);
      bus.Advance(now);
      Watch();
    }
  }
  void Watch() {
    for (std::size_t i = 0; i < kServos; ++i) {
      const double pulse = bus.Commanded(i);
      in_limits = in_limits && (pulse == 0 || (pulse >= 1000 && pulse <= 2000));
      if (pulse != 0 && last[i] != 0) fastest = std::max(fastest, std::abs(pulse - last[i]));
      last[i] = pulse;
    }
  }
  void Tick() {
    if (!cut) driver.Receive(bus.Transmit(), now);
    const auto bytes = driver.Tick(now, commands);
    if (!cut) bus.Receive(bytes, now);
    Pass(milliseconds(10));
  }
  void Run(Duration time) {
    for (const Time end = now + time; now < end;) Tick();
  }
  void RunUp(float position) {
    Run(milliseconds(200));
    All(position);
    Run(milliseconds(2500));
    ASSERT_EQ(bus.state(), kFwFollowing);
    ASSERT_EQ(bus.Commanded(0), position);
    fastest = 0;
  }
  void ForgetFastest() {
    fastest = 0;
    std::fill(last.begin(), last.end(), 0);
  }
};

TEST(FirmwareBus, FollowsTheDriverFromNeutralWithItsRampAndTheServosFollowThePulses) {
  Context c;
  c.Run(milliseconds(100));
  EXPECT_EQ(c.bus.receiver().setup.count, kServos);
  EXPECT_EQ(c.bus.Commanded(0), 0) << "a setup moves nothing";
  EXPECT_EQ(c.driver.status().state, bus::BusState::kRunning);
  c.RunUp(1800);
  EXPECT_EQ(c.driver.feedback()[3].state, bus::ServoState::kOn);
  for (std::size_t i = 0; i < kServos; ++i) {
    EXPECT_EQ(c.bus.Goal(i), 1800);
    EXPECT_NEAR(c.bus.Position(i), 1800, 15) << "dead band and play";
    EXPECT_TRUE(c.bus.TorqueOn(i));
  }
  EXPECT_EQ(c.bus.receiver().refused, 0U);
  EXPECT_EQ(FwDamaged(&c.bus.link()), 0U);
  c.Run(milliseconds(1100));
  EXPECT_EQ(c.driver.feedback()[3].position, 1800);
}

// From where the crawl of a motion starts: the receiver has the same position and the same pace.
TEST(FirmwareBus, ACrawlThatStartsWhereThePulseIsIsFollowedWithoutARampOfTheReceivers) {
  Context c;
  c.RunUp(1500);
  c.Run(milliseconds(200));
  for (float position = 1500; position < 1800; position += 0.01F * kRamp) {
    c.All(position);
    c.Tick();
    EXPECT_EQ(c.bus.state(), kFwFollowing);
    EXPECT_NEAR(c.bus.Commanded(0), position, 0.01 * kRamp * 6) << "two periods late at most";
  }
}

TEST(FirmwareBus, TorqueEndsAtTheServoSoonAfterTheCommandAndAfterARelease) {
  for (const bool release : {false, true}) {
    Context c;
    c.RunUp(1700);
    if (release) c.bus.Receive(c.driver.Release(c.now), c.now);
    c.All(1700, false);
    c.Run(milliseconds(100));
    for (std::size_t i = 0; i < kServos; ++i) {
      EXPECT_EQ(c.bus.Commanded(i), 0);
      EXPECT_FALSE(c.bus.TorqueOn(i));
      // Only a release is told back at once.
      EXPECT_EQ(c.driver.feedback()[i].torque, !release);
    }
    c.Run(milliseconds(1000));
    EXPECT_FALSE(c.driver.feedback()[0].torque);
  }
}

TEST(FirmwareBus, ADriverThatStartsAnewFindsItsServosWhereTheyAreAndTheyKeepTheirTorque) {
  Context c;
  c.RunUp(1700);
  ASSERT_TRUE(c.driver.Configure(c.config));
  for (int i = 0; i < 200 && c.driver.status().state != bus::BusState::kRunning; ++i) {
    // The motion wants torque when there is a position, as core/animatronic does.
    c.driver.Receive(c.bus.Transmit(), c.now);
    const auto& f = c.driver.feedback()[0];
    if (f.factor == 1) c.All(f.position.value_or(0));
    if (f.factor != 1) c.All(1500, false);
    c.Tick();
  }
  ASSERT_TRUE(c.driver.feedback()[0].position);
  const float found = *c.driver.feedback()[0].position;
  EXPECT_GE(found, 1499);
  EXPECT_LE(found, 1700);
  c.All(found);
  c.Run(milliseconds(100));
  EXPECT_NEAR(c.bus.Commanded(0), found, 60);
  EXPECT_LE(c.fastest, 0.02 * kTop);
  EXPECT_TRUE(c.bus.TorqueOn(0));
  EXPECT_EQ(c.bus.trace().Count(sim::EventKind::kTorqueOff), 0U);
}

TEST(FirmwareBus, ABoardThatIsResetComesBackWhereItWasAndOnePoweredUpFromNeutral) {
  for (const bool power : {false, true}) {
    Context c;
    c.RunUp(1800);
    if (power) {
      c.bus.PowerCycle(milliseconds(300));
    } else {
      c.bus.Reset(milliseconds(300));
    }
    c.ForgetFastest();
    c.Run(milliseconds(5000));
    EXPECT_EQ(c.bus.state(), kFwFollowing);
    EXPECT_EQ(c.bus.Commanded(0), 1800);
    EXPECT_LE(c.fastest, 0.02 * kRamp + 1);
    EXPECT_EQ(c.driver.status().torque_lost, kServos);
    EXPECT_EQ(c.bus.trace().Count(sim::EventKind::kReboot), 1U);
  }
}

// Every place in a frame of pulses where the line may be cut: the contract's states and times as
// the servo sees them.
TEST(FirmwareBus, WhereverAFrameIsCutTheServosHoldEaseAndAreReleasedInTheirTimes) {
  std::size_t size = 1;
  double worst_hold = 0;
  double worst_ease = 0;
  double worst_release = 0;
  for (std::size_t cut = 0; cut < size; ++cut) {
    Context c;
    c.RunUp(1800);
    c.All(1000);  // the frame that is cut asks for something else
    c.driver.Receive(c.bus.Transmit(), c.now);
    const auto frame = c.driver.Tick(c.now, c.commands);
    size = frame.size();
    // The last delimiter alone ends the frame; without it nothing of it counts.
    c.bus.Receive(frame.first(cut), c.now);
    c.cut = true;
    const Time silent = c.now - milliseconds(10);  // since the last whole frame was sent
    std::array<std::optional<Duration>, kServos> eases{};
    std::array<std::optional<Duration>, kServos> rests{};
    std::array<std::optional<Duration>, kServos> released{};
    while (c.now < silent + milliseconds(1200)) {
      c.Pass(milliseconds(1));
      for (std::size_t i = 0; i < kServos; ++i) {
        const double pulse = c.bus.Commanded(i);
        ASSERT_TRUE(pulse == 0 || (pulse >= 1500 && pulse <= 1800)) << "cut at " << cut;
        const Duration since = c.now - silent;
        if (!eases[i] && pulse < 1799) eases[i] = since;
        if (!rests[i] && pulse < 1501) rests[i] = since;
        if (!released[i] && !c.bus.TorqueOn(i)) released[i] = since;
      }
    }
    for (std::size_t i = 0; i < kServos; ++i) {
      ASSERT_TRUE(eases[i] && rests[i] && released[i]) << "cut at " << cut;
      const auto late = [](Duration is, int wanted_ms) {
        return static_cast<double>(is.count()) / 1000 - wanted_ms;
      };
      // A frame is refreshed 40 ms at the latest before the cut; a tick decides, and the next
      // period shows it. The ease takes some periods to its first us and from its last, and a
      // servo lets go two periods after its last pulse.
      EXPECT_GE(late(*eases[i], 200), -40) << cut;
      EXPECT_LE(late(*eases[i], 200), 100) << cut;
      EXPECT_GE(late(*rests[i], 600), -60) << cut;
      EXPECT_LE(late(*rests[i], 600), 60) << cut;
      EXPECT_GE(late(*released[i], 900), -40) << cut;
      EXPECT_LE(late(*released[i], 900), 100) << cut;
      worst_hold = std::max(worst_hold, std::abs(late(*eases[i], 200)));
      worst_ease = std::max(worst_ease, std::abs(late(*rests[i], 600)));
      worst_release = std::max(worst_release, std::abs(late(*released[i], 900)));
    }
    EXPECT_EQ(c.bus.state(), kFwReleased);
    EXPECT_EQ(c.bus.trace().Count(sim::EventKind::kWatchdog), 1U);
    EXPECT_TRUE(c.in_limits);
    EXPECT_LE(c.fastest, 0.02 * kTop);
  }
  std::printf(
      "%zu cuts; at the pulse, off by at most: ease begins %.0f ms, ends %.0f ms, torque off "
      "%.0f ms\n",
      size, worst_hold, worst_ease, worst_release);
}

TEST(FirmwareBus, AfterASilenceItCrawlsBackToTheCommands) {
  for (const int silence_ms : {60, 150, 350, 700, 1500, 9000}) {
    Context c;
    c.RunUp(1800);
    c.cut = true;
    c.Run(milliseconds(silence_ms));
    c.cut = false;
    c.Run(milliseconds(50));  // until what is heard shows: it may have been easing
    c.ForgetFastest();
    c.Run(milliseconds(4000));
    EXPECT_EQ(c.bus.Commanded(0), 1800) << silence_ms;
    EXPECT_LE(c.fastest, 0.02 * kRamp + 1) << silence_ms;
    EXPECT_TRUE(c.in_limits);
  }
}

TEST(FirmwareBus, OnABadLineNoPulseLeavesItsLimitsOrItsSpeed) {
  FirmwareBusOptions options;
  options.faults.line = {.lose = 0.01, .flip = 0.01, .duplicate = 0.005, .noise_per_s = 50};
  Context c(options);
  for (int i = 0; i < 6000; ++i) {
    for (std::size_t s = 0; s < kServos; ++s) {
      c.commands[s] = {
          .position = 1500 + 490 * std::sin(0.05F * static_cast<float>(i * (s + 1)) / 10),
          .torque = i % 2000 > 100};
    }
    c.Tick();
  }
  EXPECT_TRUE(c.in_limits);
  EXPECT_LE(c.fastest, 0.02 * kTop + 0.5);
  EXPECT_GT(c.bus.trace().Count(sim::EventKind::kDamagedPacket), 100U);
  EXPECT_GT(c.bus.link().sound, 1000U);
}

}  // namespace
}  // namespace facewire::firmware
