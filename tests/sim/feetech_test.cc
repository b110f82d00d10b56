#include "tests/sim/feetech.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "tests/sim/bench.h"

// Packets in quotes are those of Feetech's "Smart Bus Servo Communication Protocol Manual", 1.3.1
// to 1.3.8, which prints them in hexadecimal.

namespace facewire::sim {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

Bytes Packet(std::uint8_t id, std::uint8_t instruction, const Bytes& params) {
  Bytes packet =
      Bytes{0xFF, 0xFF, id, static_cast<std::uint8_t>(params.size() + 2), instruction} + params;
  const int sum = std::accumulate(packet.begin() + 2, packet.end(), 0);
  packet.push_back(static_cast<std::uint8_t>(~sum));
  return packet;
}
Bytes WritePacket(std::uint8_t id, std::uint8_t address, const Bytes& bytes) {
  return Packet(id, 0x03, Bytes{address} + bytes);
}
Bytes Little(int value) {
  return {static_cast<std::uint8_t>(value & 0xFF), static_cast<std::uint8_t>(value >> 8)};
}
Bytes Big(int value) {
  return {static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value & 0xFF)};
}
Bytes Goal(std::uint8_t id, int counts, int speed = 0) {
  return WritePacket(id, 42, Little(counts) + Little(0) + Little(speed));
}

FeetechOptions Chain(std::vector<std::uint8_t> ids, const FeetechSeries& series = Sts()) {
  FeetechOptions options(series);
  options.ids = std::move(ids);
  return options;
}

class StsOnBench : public testing::Test {
 protected:
  explicit StsOnBench(const FeetechOptions& options = Chain({1, 2, 3, 4})) : bench(options) {}

  Bytes Read(std::uint8_t id, std::uint8_t address, std::uint8_t length) {
    const Bytes answer = bench.Ask(Packet(id, 0x02, {address, length}));
    if (answer.size() != 6U + length) return {};
    return {answer.begin() + 5, answer.end() - 1};
  }
  int ReadLittle(std::uint8_t id, std::uint8_t address) {
    const Bytes bytes = Read(id, address, 2);
    return bytes.size() == 2 ? bytes[0] | bytes[1] << 8 : -1;
  }

  Bench<Feetech> bench;
};

TEST_F(StsOnBench, AnswersTheManualsPing) {
  EXPECT_EQ(bench.Ask(Hex("FF FF 01 02 01 FB")), Hex("FF FF 01 02 00 FC"));
}

TEST_F(StsOnBench, TakesTheManualsWriteOfAnId) {
  // Example 3 is a broadcast: every servo would get the id, none answers, and locked as they are
  // they forget it with the power.
  EXPECT_THAT(bench.Ask(Hex("FF FF FE 04 03 05 01 F4")), IsEmpty());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(bench.bus.memory(i).id(), 1);
  EXPECT_EQ(bench.Count(EventKind::kEepromTry), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    bench.bus.Inject({.kind = FaultKind::kBrownOut, .servo = i, .at = milliseconds(100)});
  }
  bench.Wait(seconds(1));
  EXPECT_EQ(bench.bus.memory(3).id(), 4);
}

TEST_F(StsOnBench, TakesTheManualsWriteOfAGoal) {
  EXPECT_EQ(bench.Ask(Hex("FF FF 01 09 03 2A 00 08 00 00 E8 03 D5")), Hex("FF FF 01 02 00 FC"));
  EXPECT_EQ(ReadLittle(1, feetech::kGoal), 2048);
  EXPECT_EQ(ReadLittle(1, feetech::kSpeed), 1000);
}

TEST_F(StsOnBench, TakesTheManualsRegWriteAndAction) {
  EXPECT_EQ(bench.Ask(Hex("FF FF 01 09 04 2A 00 08 00 00 E8 03 D4")), Hex("FF FF 01 02 00 FC"));
  EXPECT_EQ(bench.Ask(Hex("FF FF 02 09 04 2A 00 08 00 00 E8 03 D3")), Hex("FF FF 02 02 00 FB"));
  EXPECT_EQ(ReadLittle(1, feetech::kGoal), 0);
  EXPECT_THAT(bench.Ask(Hex("FF FF FE 02 05 FA")), IsEmpty());
  EXPECT_EQ(ReadLittle(1, feetech::kGoal), 2048);
  EXPECT_EQ(ReadLittle(2, feetech::kGoal), 2048);
}

TEST_F(StsOnBench, TakesTheManualsSyncWriteWithoutAnAnswer) {
  EXPECT_THAT(bench.Ask(Hex("FF FF FE 20 83 2A 06 01 00 08 00 00 E8 03 02 00 08 00 00 E8 03 03 00 "
                            "08 00 00 E8 03 04 00 08 00 00 E8 03 58")),
              IsEmpty());
  for (std::uint8_t id = 1; id <= 4; ++id) EXPECT_EQ(ReadLittle(id, feetech::kGoal), 2048);
}

TEST_F(StsOnBench, TakesSyncWriteWithAccelerations) {
  bench.Ask(Hex("FF FF FE 14 83 29 07 01 00 00 08 00 00 E8 03 02 00 00 08 00 00 E8 03 51"));
  EXPECT_EQ(ReadLittle(2, feetech::kGoal), 2048);
  EXPECT_EQ(ReadLittle(2, feetech::kSpeed), 1000);
}

TEST(StsReads, AnswersTheManualsReadOfAPosition) {
  FeetechOptions options = Chain({1});
  options.poses = {1304};
  options.servo.sensor_noise_rad = 0;
  Bench<Feetech> bench(options);
  EXPECT_EQ(bench.Ask(Hex("FF FF 01 04 02 38 02 BE")), Hex("FF FF 01 04 00 18 05 DD"));
}

TEST(StsReads, AnswersTheManualsSyncReadInTheOrderOfTheList) {
  FeetechOptions options = Chain({1, 2});
  options.poses = {2048, 2047};
  options.supply_V = 12.1;
  options.servo.sensor_noise_rad = 0;
  Bench<Feetech> bench(options);
  for (std::size_t i = 0; i < 2; ++i) {
    bench.bus.memory(i).SetByte(feetech::kMaxVoltage, 140);
    bench.bus.memory(i).SetByte(feetech::kTorque, 0);
  }
  bench.bus.servo(0).Heat(30);
  bench.bus.servo(1).Heat(35);
  // The manual's second servo shows 11.9 V; on this bench both hang on the same 12.1 V.
  EXPECT_EQ(bench.Ask(Hex("FF FF FE 06 82 38 08 01 02 36"), milliseconds(2)),
            Hex("FF FF 01 0A 00 00 08 00 00 00 00 79 1E 55") +
                Packet(2, 0x00, Hex("FF 07 00 00 00 00 79 23")));
}

TEST_F(StsOnBench, AnswersNothingToADamagedPacket) {
  Bytes packet = Packet(1, 0x01, {});
  packet.back() ^= 4;
  EXPECT_THAT(bench.Ask(packet), IsEmpty());
  EXPECT_EQ(bench.Count(EventKind::kDamagedPacket), 1U);
}

TEST_F(StsOnBench, CarriesOutADamagedPacketWhoseSumIsRight) {
  // Two bytes changed places: a sum cannot see that. Goal 2304 became 9.
  Bytes packet = Goal(1, 2304);
  std::swap(packet[6], packet[7]);
  bench.Ask(packet);
  EXPECT_EQ(bench.bus.Goal(0), 9);
  EXPECT_EQ(bench.Count(EventKind::kDamagedPacket), 0U);
}

TEST_F(StsOnBench, TakesAsManyServosInASyncWriteAsOneByteOfLengthAllows) {
  FeetechOptions options = Chain({});
  Bytes params = {41, 7};
  for (std::uint8_t id = 1; id <= 31; ++id) {
    options.ids.push_back(id);
    params = params + Bytes{id, 0} + Little(2100) + Little(0) + Little(0);
  }
  ASSERT_EQ(params.size() + 2, 252U);
  Bench<Feetech> many(options);
  many.Ask(Packet(0xFE, 0x83, params));
  EXPECT_EQ(many.bus.Goal(30), 2100);
}

TEST_F(StsOnBench, AllTalkAtOnceAfterABroadcastPing) {
  const Bytes answer = bench.Ask(Packet(0xFE, 0x01, {}));
  EXPECT_GE(bench.Count(EventKind::kCollision), 1U);
  EXPECT_NE(answer, Hex("FF FF 01 02 00 FC"));
}

TEST(StsAlone, AnswersABroadcastPing) {
  Bench<Feetech> bench(Chain({7}));
  EXPECT_EQ(bench.Ask(Packet(0xFE, 0x01, {})), Packet(7, 0x00, {}));
}

TEST_F(StsOnBench, KeepsWhatWasWrittenUnlockedAndRecordsIt) {
  bench.Ask(WritePacket(1, 55, {0}));
  bench.Ask(WritePacket(1, 13, {60}));
  bench.Ask(WritePacket(2, 13, {50}));
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kEepromWrite, 0), 1U);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kEepromTry, 1), 1U);
  for (std::size_t i = 0; i < 2; ++i) {
    bench.bus.Inject({.kind = FaultKind::kBrownOut, .servo = i, .at = seconds(1)});
  }
  bench.Wait(seconds(2));
  EXPECT_THAT(Read(1, 13, 1), ElementsAre(60));
  EXPECT_THAT(Read(2, 13, 1), ElementsAre(70));
  EXPECT_THAT(Read(1, 55, 1), ElementsAre(1));  // locked again
}

TEST_F(StsOnBench, TurnsAsFastAsItIsTold) {
  bench.Send(Goal(1, 3048, 500));
  const Duration time = bench.TimeTo(0, 3040);
  EXPECT_NEAR(std::chrono::duration<double>(time).count(), 2.0, 0.1);
}

TEST_F(StsOnBench, CountsItsSpeedInFiftiesWhenItsPhaseSaysSo) {
  bench.bus.memory(0).SetByte(feetech::kPhase, 8);
  bench.Send(Goal(1, 3048, 10));
  const Duration time = bench.TimeTo(0, 2548);
  EXPECT_NEAR(std::chrono::duration<double>(time).count(), 1.0, 0.1);
  EXPECT_NEAR(ReadLittle(1, feetech::kPresentSpeed), 10, 1);
}

TEST_F(StsOnBench, StopsAtSpeedZeroWhenItsPhaseSaysSo) {
  bench.bus.memory(0).SetByte(feetech::kPhase, 4);
  bench.Ask(Goal(1, 3048, 0));
  bench.Wait(seconds(2));
  EXPECT_NEAR(bench.bus.Position(0), 2048, 2);
}

TEST_F(StsOnBench, ASwitchedOffServoIsSwitchedOnByAGoal) {
  bench.Ask(WritePacket(1, 40, {0}));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  bench.Ask(Goal(1, 2200));
  EXPECT_TRUE(bench.bus.TorqueOn(0));
  EXPECT_THAT(Read(1, 40, 1), ElementsAre(1));
}

TEST_F(StsOnBench, ClampsAGoalToItsLimitsAndRecordsIt) {
  bench.bus.memory(0).SetWord(feetech::kMinAngle, 1900);
  bench.bus.memory(0).SetWord(feetech::kMaxAngle, 2200);
  bench.Ask(Goal(1, 3000));
  bench.Wait(seconds(2));
  EXPECT_NEAR(bench.bus.Position(0), 2200, 8);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kOutsideLimits, 0), 1U);
}

TEST_F(StsOnBench, WritesNegativeNumbersAsSignAndMagnitude) {
  bench.Ask(Goal(1, 1000, 500));
  bench.Wait(milliseconds(300));
  const int speed = ReadLittle(1, feetech::kPresentSpeed);
  EXPECT_NEAR(speed, 0x8000 + 500, 40);
  const int load = ReadLittle(1, feetech::kLoad);
  EXPECT_TRUE((load & 0x400) != 0) << load;
}

TEST_F(StsOnBench, MakesItsPlaceTheMiddleOnCommand) {
  bench.Ask(Goal(1, 2500));
  bench.Wait(seconds(2));
  bench.Ask(WritePacket(1, 40, {128}));
  EXPECT_NEAR(ReadLittle(1, feetech::kPosition), 2048, 2);
  EXPECT_GE(bench.bus.trace().Count(EventKind::kEepromWrite, 0), 1U);
}

TEST_F(StsOnBench, HasItsOffsetsSignInBitEleven) {
  bench.bus.memory(0).SetWord(feetech::kOffset, 0x0800 + 100);
  EXPECT_NEAR(ReadLittle(1, feetech::kPosition), 2148, 2);
}

TEST_F(StsOnBench, HasNoWatchdog) {
  bench.Ask(Goal(1, 2500));
  bench.Wait(std::chrono::minutes(2));
  EXPECT_TRUE(bench.bus.TorqueOn(0));
  EXPECT_EQ(bench.Count(EventKind::kWatchdog), 0U);
}

TEST_F(StsOnBench, GivesWayAfterTwoSecondsOfOverloadUntilItGetsAGoal) {
  bench.bus.servo(0).Jam(0);
  bench.Ask(Goal(1, 3000));
  bench.Wait(milliseconds(1800));
  EXPECT_GT(bench.bus.servo(0).current_A(), 2);
  bench.Wait(milliseconds(400));
  EXPECT_LT(bench.bus.servo(0).current_A(), 0.6);  // a fifth of its torque
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kOverload, 0), 1U);
  EXPECT_EQ(bench.Ask(Packet(1, 0x01, {}))[4], 1 << feetech::kLoadBit);
  bench.bus.servo(0).Unjam();
  bench.Ask(Goal(1, 2100));
  EXPECT_EQ(bench.Ask(Packet(1, 0x01, {}))[4], 0);
  bench.Wait(seconds(1));
  EXPECT_NEAR(bench.bus.Position(0), 2100, 8);
}

TEST_F(StsOnBench, SwitchesOffWhenItIsHot) {
  bench.Ask(Goal(1, 2100));
  bench.bus.servo(0).Heat(75);
  bench.Wait(milliseconds(5));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  EXPECT_EQ(bench.Ask(Packet(1, 0x01, {}))[4], 1 << feetech::kHeatBit);
}

TEST_F(StsOnBench, AnswersOnlyPingAndReadAtResponseLevelZero) {
  bench.bus.memory(0).SetByte(feetech::kResponseLevel, 0);
  EXPECT_THAT(bench.Ask(Goal(1, 2048)), IsEmpty());
  EXPECT_EQ(ReadLittle(1, feetech::kGoal), 2048);
}

TEST_F(StsOnBench, RecordsAFactoryReset) {
  bench.Ask(Packet(1, 0x06, {}));
  bench.Ask(Packet(2, 0x0A, {}));
  EXPECT_EQ(bench.Count(EventKind::kFactoryReset), 2U);
}

TEST_F(StsOnBench, FindsAPacketAfterExtraFfs) {
  EXPECT_EQ(bench.Ask(Hex("FF FF FF FF FF 01 02 01 FB")), Hex("FF FF 01 02 00 FC"));
}

class ScsOnBench : public StsOnBench {
 protected:
  ScsOnBench() : StsOnBench(Chain({1, 2}, Scs())) {}
};

TEST_F(ScsOnBench, WritesTheHighByteFirst) {
  bench.Ask(WritePacket(1, 42, Big(700) + Big(0) + Big(0)));
  bench.Wait(seconds(1));
  EXPECT_NEAR(bench.bus.Position(0), 700, 3);
  const Bytes position = Read(1, feetech::kPosition, 2);
  EXPECT_NEAR(position[0] << 8 | position[1], 700, 3);
}

TEST_F(ScsOnBench, TakesTheTimeThatItIsTold) {
  bench.Send(WritePacket(1, 42, Big(812) + Big(1500) + Big(0)));
  EXPECT_NEAR(std::chrono::duration<double>(bench.TimeTo(0, 806)).count(), 1.5, 0.1);
}

TEST_F(ScsOnBench, HasItsLockElsewhereThanTheSts) {
  bench.Ask(WritePacket(1, 55, {0}));
  bench.Ask(WritePacket(1, 13, {60}));
  EXPECT_EQ(bench.Count(EventKind::kEepromWrite), 0U);
  bench.Ask(WritePacket(1, 48, {0}));
  bench.Ask(WritePacket(1, 13, {60}));
  EXPECT_EQ(bench.Count(EventKind::kEepromWrite), 1U);
}

TEST_F(ScsOnBench, HasItsOverloadProtection) {
  bench.bus.servo(0).Jam(0);
  bench.Ask(WritePacket(1, 42, Big(900) + Big(0) + Big(0)));
  bench.Wait(milliseconds(2300));
  EXPECT_EQ(bench.Count(EventKind::kOverload), 1U);
}

}  // namespace
}  // namespace facewire::sim
