#include "tests/sim/bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "tests/sim/bench.h"
#include "tests/sim/dynamixel.h"
#include "tests/sim/feetech.h"
#include "tests/sim/maestro.h"

// What every bus has: its line, its faults, its trace; and how fast it runs.

namespace facewire::sim {
namespace {

using std::chrono::seconds;
using testing::IsEmpty;

// An hour would be too long for a build with sanitizers or on an emulated processor.
constexpr int kMinutes = FACEWIRE_SIM_MINUTES;
const Bytes kPing = Hex("FF FF 01 02 01 FB");
const Bytes kPong = Hex("FF FF 01 02 00 FC");
const Bytes kGoal3000 = Hex("FF FF 01 09 03 2A B8 0B 00 00 00 00 05");

FeetechOptions Chain(std::size_t servos) {
  FeetechOptions options;
  options.ids.clear();
  for (std::size_t i = 1; i <= servos; ++i) options.ids.push_back(static_cast<std::uint8_t>(i));
  return options;
}

class ChainOnBench : public testing::Test {
 protected:
  ChainOnBench() : bench(Chain(2)) {}
  Bench<Feetech> bench;
};

TEST_F(ChainOnBench, SaysWhenTheNextByteIsAtTheHost) {
  EXPECT_EQ(bench.bus.NextTransmit(), Time::max());
  bench.Send(kPing);
  bench.Wait(Duration(60));
  EXPECT_EQ(bench.bus.NextTransmit(), bench.now + Duration(30 + 10));
  bench.Wait(Duration(40));
  EXPECT_EQ(bench.bus.Transmit().size(), 1U);
}

TEST_F(ChainOnBench, GivesTheSameForTheSameSeed) {
  FeetechOptions options = Chain(2);
  options.faults.line = {.lose = 0.02, .flip = 0.02, .duplicate = 0.02, .late = 0.1};
  Bench<Feetech> a(options);
  Bench<Feetech> b(options);
  for (int i = 0; i < 200; ++i) EXPECT_EQ(a.Ask(kPing), b.Ask(kPing)) << i;
}

TEST_F(ChainOnBench, LosesFlipsAndDoublesBytes) {
  for (double LineFaults::*rate : {&LineFaults::lose, &LineFaults::flip, &LineFaults::duplicate}) {
    FeetechOptions options = Chain(1);
    options.faults.line.*rate = 0.05;
    Bench<Feetech> faulty(options);
    int good = 0;
    for (int i = 0; i < 200; ++i) good += faulty.Ask(kPing, milliseconds(150)) == kPong ? 1 : 0;
    EXPECT_GT(good, 50);
    EXPECT_LT(good, 190);
  }
}

TEST_F(ChainOnBench, AnswersLate) {
  bench.bus.line_faults() = {.late = 1, .late_ms = 20};
  EXPECT_THAT(bench.Ask(kPing, Duration(200)), IsEmpty());
  bench.Wait(milliseconds(21));
  EXPECT_EQ(Plain(bench.bus.Transmit()), kPong);
}

TEST_F(ChainOnBench, GivesTheHostItsOwnBytesBackBehindASimpleAdapter) {
  FeetechOptions options = Chain(1);
  options.echo = true;
  Bench<Feetech> echoing(options);
  EXPECT_EQ(echoing.Ask(kPing), kPing + kPong);
  EXPECT_EQ(echoing.Count(EventKind::kCollision), 0U);
}

TEST_F(ChainOnBench, HearsNoiseWhenNobodyTalks) {
  bench.bus.line_faults().noise_per_s = 100;
  bench.Wait(seconds(1));
  const std::size_t count = bench.bus.Transmit().size();
  EXPECT_GT(count, 60U);
  EXPECT_LT(count, 140U);
}

TEST_F(ChainOnBench, AVanishedServoIsLimpAndSilentAndComesBackAsAfterPowerOn) {
  bench.Ask(kGoal3000);
  bench.Wait(seconds(3));
  EXPECT_TRUE(bench.bus.TorqueOn(0));
  bench.bus.Inject({.kind = FaultKind::kVanish,
                    .servo = 0,
                    .at = bench.now.time_since_epoch(),
                    .lasts = seconds(1)});
  bench.Wait(milliseconds(5));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  EXPECT_THAT(bench.Ask(kPing), IsEmpty());
  bench.Wait(seconds(2));
  EXPECT_EQ(bench.Ask(kPing), kPong);
  EXPECT_FALSE(bench.bus.TorqueOn(0));
}

TEST_F(ChainOnBench, AMuteServoStillDoesWhatItWasTold) {
  bench.Send(kGoal3000);
  bench.bus.Inject(
      {.kind = FaultKind::kMute, .servo = 0, .at = milliseconds(5), .lasts = seconds(2)});
  bench.Wait(milliseconds(100));
  EXPECT_THAT(bench.Ask(kPing), IsEmpty());
  bench.Wait(seconds(3));
  EXPECT_NEAR(bench.bus.Position(0), 3000, 8);
  EXPECT_EQ(bench.Ask(kPing), kPong);
}

TEST_F(ChainOnBench, ABrownOutSwitchesTheTorqueOff) {
  bench.Send(kGoal3000);
  bench.bus.Inject({.kind = FaultKind::kBrownOut, .servo = 0, .at = milliseconds(100)});
  bench.Wait(seconds(2));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  EXPECT_LT(bench.bus.Position(0), 2800);  // it coasted
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kTorqueOff, 0), 1U);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kBrownOut, 0), 1U);
}

TEST_F(ChainOnBench, AJamEnds) {
  bench.bus.Inject({.kind = FaultKind::kJam, .servo = 0, .lasts = seconds(1), .value = 2500});
  bench.Wait(milliseconds(1));
  bench.Send(kGoal3000);
  bench.Wait(milliseconds(900));
  EXPECT_NEAR(bench.bus.Position(0), 2500, 7);
  bench.Wait(seconds(3));
  EXPECT_NEAR(bench.bus.Position(0), 3000, 8);
}

TEST_F(ChainOnBench, AHotServoProtectsItself) {
  bench.Send(kGoal3000);
  bench.bus.Inject({.kind = FaultKind::kHot, .servo = 0, .at = milliseconds(10), .value = 80});
  bench.Wait(milliseconds(20));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
}

TEST_F(ChainOnBench, AJumpOfTheSensorMovesTheServo) {
  bench.Send(kGoal3000);
  bench.Wait(seconds(3));
  bench.bus.Inject(
      {.kind = FaultKind::kJump, .servo = 0, .at = bench.now.time_since_epoch(), .value = 100});
  bench.Wait(seconds(1));
  EXPECT_NEAR(bench.bus.Position(0), 2900, 8);
}

TEST_F(ChainOnBench, ShowsEveryMillisecondOfEveryServo) {
  bench.bus.trace().KeepSamples(Trace::Keep::kEveryMillisecond);
  bench.Wait(milliseconds(100));
  EXPECT_EQ(bench.bus.trace().samples().size(), 200U);
}

TEST_F(ChainOnBench, KeepsOnlyChangesWhenAsked) {
  bench.bus.trace().KeepSamples(Trace::Keep::kChanges);
  bench.Wait(seconds(10));
  EXPECT_EQ(bench.bus.trace().samples().size(), 2U);
  bench.Send(kGoal3000);
  bench.Wait(seconds(1));
  EXPECT_GT(bench.bus.trace().samples().size(), 100U);
}

TEST_F(ChainOnBench, CallsObserversWithSamplesAndEvents) {
  float fastest = 0;
  std::vector<EventKind> kinds;
  bench.bus.trace().OnSample([&](const Sample& s) { fastest = std::max(fastest, s.speed); });
  bench.bus.trace().OnEvent([&](const Event& e) { kinds.push_back(e.kind); });
  bench.Send(kGoal3000);
  bench.Wait(seconds(1));
  EXPECT_NEAR(fastest, 52.0 / 60 * 4096, 200);
  EXPECT_THAT(kinds, testing::ElementsAre(EventKind::kTorqueOn));
}

TEST(TraceCsv, HasAsManyFieldsInEveryRow) {
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  EXPECT_EQ(commas(CsvLine(Sample{})), commas(CsvHeader()));
  const Event event{Time{}, 1, EventKind::kBurnt, 110};
  EXPECT_EQ(commas(CsvLine(event)), commas(CsvHeader()));
  EXPECT_EQ(CsvLine(event), "0,1,burnt,110,,,,,,,,,\n");
}

TEST(FaultText, IsARateOrAFault) {
  FaultPlan plan;
  EXPECT_EQ(AddFault("lose=0.25", plan), std::nullopt);
  EXPECT_EQ(AddFault("jam:3@2.5+1=1600", plan), std::nullopt);
  EXPECT_EQ(AddFault("vanish:0@0", plan), std::nullopt);
  EXPECT_EQ(plan.line.lose, 0.25);
  ASSERT_EQ(plan.faults.size(), 2U);
  EXPECT_EQ(plan.faults[0].kind, FaultKind::kJam);
  EXPECT_EQ(plan.faults[0].servo, 3U);
  EXPECT_EQ(plan.faults[0].at, milliseconds(2500));
  EXPECT_EQ(plan.faults[0].lasts, seconds(1));
  EXPECT_EQ(plan.faults[0].value, 1600);
}

TEST(FaultText, IsRefusedInOneLineThatNamesWhatWouldBeRight) {
  for (const char* text : {"", "lose", "lose=2", "lose=-1", "lose=nan", "lose=0.1x", "jam:3@2",
                           "jam", "hot:0@1+", "hot:x@1=80", "mute:0@-1", "vanish:0@1=5", "melt:0@1",
                           "mute:1.5@0", "mute:300@0", "mute:0@1e99"}) {
    FaultPlan plan;
    const std::optional<std::string> why = AddFault(text, plan);
    ASSERT_TRUE(why.has_value()) << text;
    EXPECT_EQ(why->find('\n'), std::string::npos);
    EXPECT_NE(why->find("'" + std::string(text) + "'"), std::string::npos) << *why;
  }
}

TEST(RandomFaults, AreTheSameForASeedAndInOrder) {
  const auto a = RandomFaults(7, 4, std::chrono::minutes(10), 6, 0, 4095);
  const auto b = RandomFaults(7, 4, std::chrono::minutes(10), 6, 0, 4095);
  ASSERT_EQ(a.size(), 60U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].at, b[i].at);
    EXPECT_EQ(a[i].value, b[i].value);
    EXPECT_LT(a[i].servo, 4U);
    EXPECT_GE(a[i].at, a[i == 0 ? 0 : i - 1].at);
  }
  EXPECT_NE(a[0].at, RandomFaults(8, 4, std::chrono::minutes(10), 6, 0, 4095)[0].at);
}

TEST(AnyBytes, NeverDoHarm) {
  Random random(3);
  Bench<Feetech> sts(Chain(3));
  DynamixelOptions three;
  three.ids = {1, 2, 3};
  Bench<Dynamixel> xl(three);
  Bench<Maestro> maestro(MaestroOptions{});
  for (int i = 0; i < 3000; ++i) {
    Bytes bytes;
    if (random.Chance(0.3)) bytes = Hex("FF FF FD 00 01");
    if (random.Chance(0.3)) bytes = Hex("FF FF 01");
    for (auto n = random.Next() % 30; n > 0; --n) bytes.push_back(random.Byte());
    sts.Ask(bytes, milliseconds(5));
    xl.Ask(bytes, milliseconds(5));
    maestro.Ask(bytes, milliseconds(5));
  }
}

// Ten minutes of everything that can go wrong, while the host goes on as if nothing were.
template <class SomeBus, class Options>
void Suffer(Options options, const std::vector<Bytes>& goals) {
  options.faults.line = {
      .lose = 1e-3, .flip = 1e-3, .duplicate = 1e-3, .late = 0.02, .noise_per_s = 5};
  options.loads.assign(2, {.gravity_Nm = 0.05});
  Bench<SomeBus> bench(options);
  const auto total = std::chrono::minutes(10);
  const double low = bench.bus.ToOwn(-60 * kDegree);
  const double high = bench.bus.ToOwn(60 * kDegree);
  for (const Fault& f : RandomFaults(5, bench.bus.servos(), total, 30, low, high)) {
    bench.bus.Inject(f);
  }
  bench.bus.trace().OnSample([&](const Sample& s) {
    ASSERT_TRUE(std::isfinite(s.position) && std::isfinite(s.speed));
    ASSERT_LT(std::abs(s.current_A), 10);
    ASSERT_GE(s.temperature_C, 20);
    ASSERT_LT(s.temperature_C, 150);
    ASSERT_LT(s.voltage_V, options.supply_V + 0.01);
  });
  for (int i = 0; i < 6000; ++i) {
    bench.Ask(goals[static_cast<std::size_t>(i / 20) % goals.size()], milliseconds(100));
  }
  EXPECT_GT(bench.Count(EventKind::kFault), 200U);
  EXPECT_GE(bench.Count(EventKind::kFault), bench.Count(EventKind::kFaultEnds));
}

TEST(EveryFault, LeavesTheNumbersSane) {
  Suffer<Feetech>(Chain(2), {kGoal3000, Hex("FF FF 01 09 03 2A E8 03 00 00 00 00 DD"), kPing});
  DynamixelOptions chain;
  chain.ids = {1, 2};
  Suffer<Dynamixel>(chain, {Hex("FF FF FD 00 01 03 00 01 19 4E"),
                            Hex("FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 "
                                "82 87")});
  Suffer<Maestro>(MaestroOptions{}, {Hex("84 00 70 2E"), Hex("84 01 00 40"), Hex("A1")});
}

// An hour of a face: twelve servos get a goal a hundred times a second and are all read ten times a
// second. Prints what it took; a slow machine is no error.
TEST(SimulatedHour, OfTwelveServosAtAHundredHertzTakesSeconds) {
  const auto began = std::chrono::steady_clock::now();
  Bench<Feetech> bench(Chain(12));
  Bytes read = Hex("FF FF FE 10 82 38 0F");
  for (std::uint8_t id = 1; id <= 12; ++id) read.push_back(id);
  const auto close = [](Bytes packet) {
    unsigned sum = 0;
    for (std::size_t i = 2; i < packet.size(); ++i) sum += packet[i];
    packet.push_back(static_cast<std::uint8_t>(~sum));
    return packet;
  };
  read = close(read);
  const int ticks = kMinutes * 60 * 100;
  std::size_t answered = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    Bytes write = Hex("FF FF FE 64 83 29 07");
    for (std::uint8_t id = 1; id <= 12; ++id) {
      const double t = tick / 100.0 + id;
      const auto goal = static_cast<int>(2048 + 300 * std::sin(t) + 100 * std::sin(5.3 * t));
      write = write + Bytes{id,
                            0,
                            static_cast<std::uint8_t>(goal & 0xFF),
                            static_cast<std::uint8_t>(goal >> 8),
                            0,
                            0,
                            0,
                            0};
    }
    bench.Send(close(write));
    if (tick % 10 == 0) bench.Send(read);
    bench.Wait(milliseconds(10));
    answered += bench.bus.Transmit().size();
  }
  EXPECT_EQ(answered, static_cast<std::size_t>(ticks / 10 * 12 * (6 + 15)));
  EXPECT_EQ(bench.Count(EventKind::kCollision), 0U);
  EXPECT_EQ(bench.Count(EventKind::kDamagedPacket), 0U);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  std::printf("%d simulated minutes took %.2f s\n", kMinutes, took.count());
}

}  // namespace
}  // namespace facewire::sim
