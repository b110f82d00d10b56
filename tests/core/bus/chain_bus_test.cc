#include "core/bus/chain_bus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "tests/core/bus/chain_context.h"

namespace facewire::bus {
namespace {

using What = Written::What;

// What holds for every chain, whatever its protocol.
template <class Kind>
class ChainBusTest : public testing::Test {};
using Kinds = testing::Types<DynamixelKind, FeetechKind>;
TYPED_TEST_SUITE(ChainBusTest, Kinds);

template <class Peer>
std::size_t Count(const Peer& peer, What what, int id = 0) {
  return static_cast<std::size_t>(std::ranges::count_if(
      peer.written, [&](const Written& w) { return w.what == what && (id == 0 || w.id == id); }));
}

TYPED_TEST(ChainBusTest, FindsAllServosChecksThemAndReadsPositionsBeforeAnyTorque) {
  ChainContext<TypeParam> c;
  c.Tick();
  EXPECT_EQ(c.bus.status().state, BusState::kStarting);
  c.Run(milliseconds(500));
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_TRUE(c.bus.status().findings.empty());
  for (int id = 1; id <= 3; ++id) {
    EXPECT_EQ(c.state(id), ServoState::kLimp);
    EXPECT_EQ(c.feedback(id).position, 2000 + 10 * id);
    EXPECT_EQ(c.feedback(id).temperature_c, 30);
    EXPECT_EQ(c.feedback(id).factor, 1);
    EXPECT_FALSE(c.feedback(id).torque);
  }
  EXPECT_TRUE(c.peer.written.empty());
  EXPECT_EQ(c.bus.status().lost, 0U);
}

TYPED_TEST(ChainBusTest, TorqueComesAfterTheServoHasRepeatedItsGoal) {
  ChainContext<TypeParam> c(1);
  c.RunUp();
  std::vector<What> order;
  for (const Written& w : c.peer.written) {
    if (w.what == What::kTorque && w.value == 1) break;
    if (w.what == What::kGoal) {
      EXPECT_EQ(w.value, 2010);
    }
    order.push_back(w.what);
  }
  EXPECT_TRUE(std::ranges::count(order, What::kGoal));
  EXPECT_TRUE(std::ranges::count(order, What::kSpeed));
  EXPECT_TRUE(c.feedback(1).torque);
  EXPECT_EQ(c.servo(1).position, 2010);  // it did not move
}

TYPED_TEST(ChainBusTest, AGoalThatWasPreparedLongAgoIsPreparedAgainBeforeTorque) {
  ChainContext<TypeParam> c(1);
  std::map<std::size_t, int> sizes;  // of replies; by far the most are readings of a limp servo
  c.damage = [&](Bytes& reply) { ++sizes[reply.size()]; };
  c.Run(milliseconds(2000));
  const auto readings = std::ranges::max_element(sizes, {}, [](const auto& s) { return s.second; });
  // For a while nothing of what it was told is heard back.
  const Time until = c.now + milliseconds(2500);
  c.damage = [&](Bytes& reply) {
    if (c.now < until && reply.size() != readings->first) reply.clear();
  };
  int goal = 1500;
  while (!c.servo(1).torque && c.now < until + milliseconds(2000)) {
    c.Command(1, static_cast<float>(++goal));
    c.Tick();
  }
  ASSERT_TRUE(c.servo(1).torque);
  EXPECT_GE(c.servo(1).goal, goal - 100) << "as it was a second ago at most";
}

TYPED_TEST(ChainBusTest, TorqueFromBeforeStaysWhereTheMotionGoesOnFromThere) {
  ChainContext<TypeParam> c(1);
  c.servo(1).torque = true;
  while (c.state(1) != ServoState::kLimp) {
    c.Tick();
    c.Deliver(c.now);
  }
  EXPECT_EQ(c.feedback(1).factor, 1);
  c.Command(1, *c.feedback(1).position);
  for (int i = 0; i < 100; ++i) {
    c.Tick();
    EXPECT_TRUE(c.servo(1).torque);
  }
  EXPECT_EQ(c.state(1), ServoState::kOn);
}

TYPED_TEST(ChainBusTest, AnOldGoalNeverBecomesAJumpWhateverPacketIsLost) {
  for (std::size_t lost = 0; lost < 60; ++lost) {
    static std::size_t which;
    ChainContext<TypeParam> c(1);
    c.Run(milliseconds(500));
    c.StartAll();
    which = c.peer.packets.size() + lost;
    c.peer.lose = [](std::size_t packet) { return packet == which; };
    for (int i = 0; i < 300; ++i) {
      c.Tick();
      if (c.servo(1).torque) {
        ASSERT_EQ(c.servo(1).goal, 2010) << lost;
      }
      c.peer.Move(1000);
    }
    ASSERT_EQ(c.state(1), ServoState::kOn) << lost;
  }
}

TYPED_TEST(ChainBusTest, APositionIsBelievedWhenTwoAgree) {
  ChainContext<TypeParam> c(1);
  for (int i = 0; i < 100; ++i) {
    c.servo(1).position = i % 2 == 0 ? 1200 : 2800;  // by each question another one
    if (i % 4 >= 2) c.servo(1).position += 200;
    c.Tick();
    ASSERT_NE(c.state(1), ServoState::kLimp);
    ASSERT_FALSE(c.feedback(1).position);
  }
  c.servo(1).position = 2000;
  c.Run(milliseconds(100));
  EXPECT_EQ(c.state(1), ServoState::kLimp);
  EXPECT_EQ(c.feedback(1).position, 2000);
}

TYPED_TEST(ChainBusTest, ServosGetTheirTorqueOneAfterTheOther) {
  ChainContext<TypeParam> c(5);
  c.Run(milliseconds(500));
  c.StartAll();
  std::size_t before = 0;
  for (int i = 0; i < 150; ++i) {
    c.Tick();
    const auto on = static_cast<std::size_t>(
        std::ranges::count_if(c.peer.servos, [](const auto& s) { return s.second.torque; }));
    EXPECT_LE(on, before + 1);
    before = on;
  }
  EXPECT_EQ(before, 5U);
}

TYPED_TEST(ChainBusTest, AStillFaceSendsNothingNewAndKeepsEveryServoFed) {
  ChainContext<TypeParam> c;
  c.RunUp();
  c.peer.written.clear();
  c.Run(milliseconds(10'000));
  for (int id = 1; id <= 3; ++id) {
    EXPECT_NEAR(static_cast<double>(Count(c.peer, What::kGoal, id)), 100, 2);  // each refresh
  }
  for (const Written& w : c.peer.written) {
    if (w.what == What::kGoal) {
      EXPECT_EQ(w.value, 2000 + 10 * w.id);
    }
  }
  EXPECT_EQ(Count(c.peer, What::kTorque), 0U);
}

TYPED_TEST(ChainBusTest, AChangedGoalGoesOutWithTheTickThatBringsItAndAlone) {
  ChainContext<TypeParam> c;
  c.RunUp();
  for (int i = 1; i <= 100; ++i) {
    c.Command(2, static_cast<float>(2020 + i));
    c.peer.written.clear();
    c.Tick();
    ASSERT_EQ(c.servo(2).goal, 2020 + i);
  }
}

TYPED_TEST(ChainBusTest, PositionsAreRoundedToCountsAndNeverLeaveTheirRange) {
  ChainContext<TypeParam> c(1);
  c.RunUp();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::array<std::pair<float, int>, 8> cases = {{{2000.4F, 2000},
                                                       {2000.6F, 2001},
                                                       {999, 1000},
                                                       {-1e30F, 1000},
                                                       {3001, 3000},
                                                       {1e30F, 3000},
                                                       {std::nanf(""), 3000},  // as before
                                                       {kInfinity, 3000}}};
  for (const auto& [position, goal] : cases) {
    c.Command(1, position);
    c.Tick();
    EXPECT_EQ(c.servo(1).goal, goal) << position;
  }
}

TYPED_TEST(ChainBusTest, NothingIsSaidWhileAReplyIsDue) {
  ChainContext<TypeParam> c(1);
  c.RunUp();
  c.delay = milliseconds(15);
  bool due = false;
  for (int i = 0; i < 200; ++i) {
    c.Command(1, static_cast<float>(2000 + i));
    const std::size_t asked = c.bus.status().questions;
    const std::size_t replies = c.bus.status().replies;
    c.Tick();
    // The reply to a question of the tick before is not there yet.
    if (due && c.bus.status().replies == replies) {
      EXPECT_EQ(c.last_bytes, 0U);
    }
    due = c.bus.status().questions != asked;
  }
  EXPECT_GT(c.bus.status().held_back, 10U);
  EXPECT_EQ(c.bus.status().lost, 0U);
}

TYPED_TEST(ChainBusTest, FeedbackKeepsToItsShareOfTheLine) {
  ChainContext<TypeParam> c(1);
  c.config.bus.baud = 57'600;
  c.config.bus.feedback_share = 0.1F;
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.RunUp();
  const std::uint64_t before = c.bus.status().questions;
  c.Run(milliseconds(10'000));
  // A status question and its reply take at least 20 bytes: 3.5 ms, so one each 35 ms at most.
  EXPECT_LT(c.bus.status().questions - before, 290U);
  EXPECT_GT(c.bus.status().questions - before, 50U);
}

TYPED_TEST(ChainBusTest, AServoThatFallsSilentIsReportedAndTheOthersGoOn) {
  ChainContext<TypeParam> c;
  c.RunUp();
  c.servo(2).answers = false;
  c.Run(milliseconds(3000));
  EXPECT_EQ(c.state(2), ServoState::kAbsent);
  EXPECT_EQ(c.feedback(2).factor, 0);
  EXPECT_EQ(c.feedback(2).reason, Reason::kAbsent);
  EXPECT_GE(c.feedback(2).lost, 5U);
  EXPECT_EQ(c.state(1), ServoState::kOn);
  EXPECT_EQ(c.state(3), ServoState::kOn);
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_FALSE(c.servo(2).torque) << "it hears though it is not heard";
  const std::uint64_t held = c.bus.status().held_back;
  c.Run(milliseconds(10'000));
  EXPECT_LT(c.bus.status().held_back - held, 60U) << "it is looked for at a slow pace";
  // It comes back by the same steps as at the start.
  c.servo(2).answers = true;
  c.Run(milliseconds(2000));
  EXPECT_EQ(c.state(2), ServoState::kOn);
  EXPECT_TRUE(c.servo(2).torque);
}

TYPED_TEST(ChainBusTest, AServoWithAnUnsafeModeIsLeftLimpAndNamed) {
  ChainContext<TypeParam> c;
  c.servo(2).mode = 1;
  c.Run(milliseconds(500));
  c.StartAll();
  c.Run(milliseconds(1000));
  EXPECT_EQ(c.state(2), ServoState::kRefused);
  EXPECT_FALSE(c.servo(2).torque);
  EXPECT_EQ(c.feedback(2).reason, Reason::kSettings);
  ASSERT_EQ(c.bus.status().findings.size(), 1U);
  const Finding& finding = c.bus.status().findings[0];
  EXPECT_EQ(finding.servo, 1);
  EXPECT_EQ(finding.setting, Setting::kOperatingMode);
  EXPECT_EQ(finding.found, finding.wanted + 1);
  EXPECT_TRUE(finding.refused);
  EXPECT_EQ(c.state(1), ServoState::kOn);
  // Put right by somebody, it is taken without a restart.
  c.servo(2).mode = 0;
  c.Run(milliseconds(3000));
  EXPECT_EQ(c.state(2), ServoState::kOn);
  EXPECT_TRUE(c.bus.status().findings.empty());
}

TYPED_TEST(ChainBusTest, LimitsThatAreNotTheRigsAreToldAndDoNotStopIt) {
  ChainContext<TypeParam> c(1);
  c.servo(1).min = 5;
  c.servo(1).max = 4095;
  c.Run(milliseconds(500));
  ASSERT_EQ(c.bus.status().findings.size(), 2U);
  EXPECT_EQ(c.bus.status().findings[0].setting, Setting::kMinPosition);
  EXPECT_EQ(c.bus.status().findings[0].found, 5);
  EXPECT_EQ(c.bus.status().findings[0].wanted, 1000);
  EXPECT_EQ(c.bus.status().findings[1].setting, Setting::kMaxPosition);
  EXPECT_EQ(c.state(1), ServoState::kLimp);
}

TYPED_TEST(ChainBusTest, ABusOfRefusedServosIsInFault) {
  ChainContext<TypeParam> c(2);
  c.servo(1).mode = c.servo(2).mode = 1;
  c.Run(milliseconds(1000));
  EXPECT_EQ(c.bus.status().state, BusState::kFault);
  EXPECT_EQ(c.bus.status().fault, BusFault::kSettings);
}

TYPED_TEST(ChainBusTest, SilenceIsAFaultUntilTheSupplyIsSwitchedOn) {
  ChainContext<TypeParam> c;
  for (auto& [id, servo] : c.peer.servos) servo.answers = false;
  c.Run(milliseconds(1000));
  EXPECT_EQ(c.bus.status().state, BusState::kFault);
  EXPECT_EQ(c.bus.status().fault, BusFault::kNobodyAnswers);
  for (auto& [id, servo] : c.peer.servos) servo.answers = true;
  c.Run(milliseconds(3000));
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_EQ(c.state(3), ServoState::kLimp);
}

TYPED_TEST(ChainBusTest, ALineThatEchoesIsNamed) {
  ChainContext<TypeParam> c(1);
  c.servo(1).answers = false;
  for (int i = 0; i < 200; ++i) {
    const auto bytes = c.bus.Tick(c.now, c.commands);
    const Bytes echo(bytes.begin(), bytes.end());
    c.bus.Receive(echo, c.now);
    if (i == 100) {  // the first packet to everybody
      const auto release = c.bus.Release(c.now);
      const Bytes all(release.begin(), release.end());
      c.bus.Receive(all, c.now);
    }
    c.now += c.period;
  }
  EXPECT_EQ(c.bus.status().state, BusState::kFault);
  EXPECT_EQ(c.bus.status().fault, BusFault::kEcho);
}

TYPED_TEST(ChainBusTest, AServoThatDropsItsTorqueIsArmedAnew) {
  ChainContext<TypeParam> c;
  c.RunUp();
  c.servo(1).torque = false;  // its supply was cut for a moment
  c.servo(1).goal = 0;
  c.peer.written.clear();
  for (int i = 0; i < 300; ++i) {
    c.Tick();
    if (c.servo(1).torque) {
      EXPECT_EQ(c.servo(1).goal, 2010);
    }
  }
  EXPECT_EQ(c.bus.status().torque_lost, 1U);
  EXPECT_EQ(c.state(1), ServoState::kOn);
}

TYPED_TEST(ChainBusTest, AServoFarFromItsGoalGoesThereSlowlyAndThenFollows) {
  ChainContext<TypeParam> c(1);
  c.servo(1).position = 3500;  // beyond its range, by hand
  c.Run(milliseconds(500));
  c.Command(1, 3000);
  for (int i = 0; i < 100; ++i) {
    c.Tick();
    c.peer.Move(4);
    if (c.servo(1).torque && c.servo(1).position > 3060) {
      ASSERT_EQ(c.servo(1).speed, TypeParam::kSlow) << c.servo(1).position;
      ASSERT_EQ(c.servo(1).acceleration, TypeParam::kGentle);
    }
  }
  c.Run(milliseconds(1500));
  EXPECT_EQ(c.servo(1).position, 3000);
  EXPECT_EQ(c.servo(1).speed, TypeParam::kFast);
  EXPECT_EQ(c.servo(1).acceleration, 0);
}

TYPED_TEST(ChainBusTest, AServoThatALoadKeepsFromItsGoalHasArrivedWhenItRests) {
  ChainContext<TypeParam> c(1);
  c.Run(milliseconds(500));
  c.Command(1, 2040);  // 30 counts away, and it does not move
  for (int i = 0; i < 200; ++i) c.Tick();
  EXPECT_EQ(c.servo(1).position, 2010);
  EXPECT_EQ(c.servo(1).speed, TypeParam::kFast);
}

TYPED_TEST(ChainBusTest, AServosOwnTopSpeedIsKeptAfterItsArrival) {
  for (const float top : {800.0F, 400.0F}) {  // the second is that of the arrival
    ChainContext<TypeParam> c(1);
    c.config.bus.servos[0].top_speed_per_s = top;
    c.config.bus.servos[0].arrive_acceleration_per_s2 = 0;
    ASSERT_TRUE(c.bus.Configure(c.config));
    c.RunUp();
    c.Run(milliseconds(3000));
    EXPECT_EQ(c.servo(1).speed, top == 400 ? TypeParam::kSlow : TypeParam::kTop);
    c.peer.written.clear();
    c.Run(milliseconds(3000));
    for (const Written& w : c.peer.written) {
      EXPECT_NE(w.what, What::kWatchdog);
      EXPECT_EQ(w.what == What::kGoal || w.value == c.servo(1).speed, true);
    }
    EXPECT_NEAR(static_cast<double>(Count(c.peer, What::kGoal)), 30, 2);
  }
}

TYPED_TEST(ChainBusTest, TorqueOffIsRepeatedUntilTheServoSaysSo) {
  ChainContext<TypeParam> c;
  c.RunUp();
  c.servo(2).deaf = true;
  c.LimpAll();
  c.Run(milliseconds(1000));
  EXPECT_FALSE(c.servo(1).torque);
  EXPECT_TRUE(c.servo(2).torque);
  c.servo(2).deaf = false;
  c.Run(milliseconds(200));
  EXPECT_FALSE(c.servo(2).torque);
  EXPECT_EQ(c.state(2), ServoState::kLimp);
  c.Run(milliseconds(1000));
  c.peer.written.clear();
  c.Run(milliseconds(5000));
  EXPECT_TRUE(c.peer.written.empty()) << "a limp servo is left alone";
}

TYPED_TEST(ChainBusTest, AHotServoIsSlowedThenLetGoThenTakenBack) {
  ChainContext<TypeParam> c(2);
  c.RunUp();
  c.servo(1).temperature = 60;
  c.Run(milliseconds(500));
  EXPECT_NEAR(c.feedback(1).factor, 0.5, 0.01);
  EXPECT_EQ(c.feedback(1).reason, Reason::kHeat);
  EXPECT_EQ(c.state(1), ServoState::kOn);
  c.servo(1).temperature = 65;
  c.Run(milliseconds(500));
  EXPECT_EQ(c.feedback(1).factor, 0);
  EXPECT_FALSE(c.servo(1).torque) << "whatever is commanded";
  EXPECT_EQ(c.state(2), ServoState::kOn);
  c.servo(1).temperature = 55;
  c.Run(milliseconds(10'000));
  EXPECT_EQ(c.feedback(1).factor, 0) << "not cool yet";
  c.servo(1).temperature = 50;
  c.Run(milliseconds(6000));
  EXPECT_EQ(c.feedback(1).factor, 1);
  EXPECT_EQ(c.state(1), ServoState::kOn);
}

TYPED_TEST(ChainBusTest, AHardwareFaultLetsTheServoGoAndIsNamed) {
  ChainContext<TypeParam> c(2);
  c.RunUp();
  c.servo(1).errors = TypeParam::kOverloadError;
  c.Run(milliseconds(1000));
  EXPECT_EQ(c.feedback(1).faults, Bit(HardwareFault::kOverload));
  EXPECT_EQ(c.feedback(1).factor, 0);
  EXPECT_EQ(c.feedback(1).reason, Reason::kHardware);
  EXPECT_FALSE(c.servo(1).torque);
  EXPECT_EQ(c.state(2), ServoState::kOn);
  ASSERT_TRUE(c.bus.Reboot(0));
  c.Run(milliseconds(500));
  EXPECT_EQ(c.servo(1).reboots, 1);
  c.Run(milliseconds(8000));
  EXPECT_EQ(c.servo(1).reboots, 1);
  EXPECT_EQ(c.feedback(1).faults, 0);
  EXPECT_EQ(c.state(1), ServoState::kOn);
  EXPECT_EQ(c.bus.Reboot(2).error(), Errc::kOutOfRange);
}

TYPED_TEST(ChainBusTest, AWeakSupplyIsToldAndDropsNobody) {
  ChainContext<TypeParam> c(1);
  c.RunUp();
  c.servo(1).errors = TypeParam::kVoltageError;
  c.Run(milliseconds(2000));
  EXPECT_EQ(c.feedback(1).faults, Bit(HardwareFault::kVoltage));
  EXPECT_EQ(c.state(1), ServoState::kOn);
}

TYPED_TEST(ChainBusTest, ReleaseLetsEverybodyGoAtAnyMoment) {
  for (int moment = 0; moment < 150; moment += 7) {
    ChainContext<TypeParam> c;
    c.Run(milliseconds(300));
    c.StartAll();
    for (int i = 0; i < moment; ++i) c.Tick();
    c.peer.Hear(c.bus.Release(c.now));
    for (const auto& [id, servo] : c.peer.servos) ASSERT_FALSE(servo.torque) << moment;
    c.LimpAll();
    c.peer.written.clear();
    c.Run(milliseconds(3000));
    for (const Written& w : c.peer.written) {
      ASSERT_TRUE(w.what == What::kTorque && w.value == 0) << moment;
    }
  }
}

TYPED_TEST(ChainBusTest, AServoThatHeldOnFromBeforeIsTakenOverWithoutADrop) {
  ChainContext<TypeParam> c(1);
  c.servo(1).torque = true;
  c.servo(1).goal = c.servo(1).position;
  bool dropped = false;
  for (int i = 0; i < 200; ++i) {
    if (c.state(1) == ServoState::kLimp) c.StartAll();
    c.commands[0].torque = true;
    c.Tick();
    dropped = dropped || !c.servo(1).torque;
  }
  EXPECT_FALSE(dropped);
  EXPECT_EQ(c.state(1), ServoState::kOn);
}

TYPED_TEST(ChainBusTest, RepliesMayComeCutAtEveryByte) {
  for (std::size_t cut = 0; cut < 80; ++cut) {
    ChainContext<TypeParam> c(2);
    for (int i = 0; i < 60; ++i) {
      const auto bytes = c.bus.Tick(c.now, c.commands);
      Bytes all;
      for (const Bytes& reply : c.peer.Hear(bytes))
        all.insert(all.end(), reply.begin(), reply.end());
      const std::size_t at = std::min(cut, all.size());
      c.bus.Receive(std::span(all).first(at), c.now + milliseconds(1));
      c.bus.Receive(std::span(all).subspan(at), c.now + milliseconds(2));
      c.now += c.period;
    }
    ASSERT_EQ(c.bus.status().lost, 0U) << cut;
    ASSERT_EQ(c.state(2), ServoState::kLimp) << cut;
  }
}

TYPED_TEST(ChainBusTest, RepliesThatEndEarlyAreLostAndNothingElseIs) {
  for (std::size_t kept = 0; kept < 60; ++kept) {
    ChainContext<TypeParam> c(1);
    int reply = 0;
    c.damage = [&](Bytes& bytes) {
      if (++reply % 3 == 0 && bytes.size() > kept) bytes.resize(kept);
    };
    c.Run(milliseconds(1000));
    c.StartAll();
    c.Run(milliseconds(2000));
    ASSERT_EQ(c.state(1), ServoState::kOn) << kept;
  }
}

// Whatever comes back: no crash, no waiting for ever, and no goal but the commanded ones, none
// outside the range; and when the noise ends, all is well again.
TYPED_TEST(ChainBusTest, NoReplyHoweverDamagedMovesAServo) {
  std::mt19937 random(17);
  for (int round = 0; round < 60; ++round) {
    ChainContext<TypeParam> c(4);
    const unsigned kind = random() % 4;
    c.damage = [&](Bytes& bytes) {
      switch (kind) {
        case 0:  // one byte
          bytes[random() % bytes.size()] = static_cast<std::byte>(random());
          break;
        case 1:  // noise alone
          bytes.assign(random() % 200, std::byte{});
          for (std::byte& b : bytes) b = static_cast<std::byte>(random());
          break;
        case 2:  // lost bytes
          bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size()));
          break;
        default:  // sometimes nothing, sometimes twice
          if (random() % 2 == 0) {
            bytes.clear();
          } else {
            bytes.insert(bytes.end(), bytes.begin(), bytes.end());
          }
      }
    };
    std::set<int> commanded;
    int quiet = 0;
    for (int i = 0; i < 600; ++i) {
      for (int id = 1; id <= 4; ++id) {
        const float position = static_cast<float>(random() % 6000) - 1000;
        c.Command(id, position, random() % 50 != 0);
        commanded.insert(static_cast<int>(std::lround(std::clamp(position, 1000.0F, 3000.0F))));
      }
      c.Tick();
      quiet = c.last_bytes == 0 ? quiet + 1 : 0;
      ASSERT_LT(quiet, 100) << "it blocks";  // the pace at which who is absent is looked for: 50
      c.peer.Move(20);
    }
    for (const Written& w : c.peer.written) {
      if (w.what == What::kGoal) {
        ASSERT_TRUE(commanded.contains(w.value)) << w.value;
      }
    }
    c.damage = nullptr;
    for (int id = 1; id <= 4; ++id) c.Command(id, 2000);
    c.Run(milliseconds(8000));
    for (int id = 1; id <= 4; ++id) {
      ASSERT_EQ(c.state(id), ServoState::kOn) << round;
      ASSERT_EQ(c.servo(id).goal, 2000);
    }
  }
}

TYPED_TEST(ChainBusTest, SixtyFourServosFitAndAllOfThemMoveEachTick) {
  ChainContext<TypeParam> c(64);
  c.config.bus.torque_interval = Duration::zero();
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.Run(milliseconds(4000));
  c.StartAll();
  c.Run(milliseconds(6000));
  for (int round = 0; round < 10; ++round) {
    for (int id = 1; id <= 64; ++id) c.Command(id, static_cast<float>(1500 + id + 100 * round));
    while (c.Tick().empty()) {
    }
    for (int id = 1; id <= 64; ++id) ASSERT_EQ(c.servo(id).goal, 1500 + id + 100 * round) << id;
    ASSERT_LE(c.last_bytes, kMaxTickBytes);
  }
}

TYPED_TEST(ChainBusTest, RestartFindsEverybodyAgain) {
  ChainContext<TypeParam> c;
  c.RunUp();
  c.bus.Restart();
  EXPECT_EQ(c.bus.status().state, BusState::kStarting);
  EXPECT_EQ(c.state(1), ServoState::kAbsent);
  c.line.clear();
  c.Run(milliseconds(2000));
  EXPECT_EQ(c.state(1), ServoState::kOn);
}

TYPED_TEST(ChainBusTest, AConfigurationThatMakesNoSenseIsRefused) {
  const auto error = [](auto change) {
    ChainContext<TypeParam> c;
    change(c.config.bus);
    const auto done = c.bus.Configure(c.config);
    return done ? Errc{} : done.error();
  };
  EXPECT_EQ(error([](BusConfig&) {}), Errc{});
  EXPECT_EQ(error([](BusConfig& b) { b.servos.clear(); }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.servos[0].id = b.servos[1].id; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.servos[0].id = 254; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.servos[0].min = 3001; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.servos[0].min = std::nanf(""); }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.servos[0].arrive_speed_per_s = 0; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.feedback_share = 0; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.refresh = Duration::zero(); }), Errc::kOutOfRange);
  EXPECT_EQ(error([](BusConfig& b) { b.gone_after = 0; }), Errc::kOutOfRange);
}

TYPED_TEST(ChainBusTest, WithoutAConfigurationNothingIsSaid) {
  typename TypeParam::Bus bus;
  EXPECT_TRUE(bus.Tick(Time(), {}).empty());
  EXPECT_TRUE(bus.Release(Time()).empty());
  EXPECT_EQ(bus.status().fault, BusFault::kNotConfigured);
}

}  // namespace
}  // namespace facewire::bus
