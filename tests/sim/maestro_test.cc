#include "tests/sim/maestro.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim/bench.h"

// Bytes in quotes are those of the Maestro user's guide (pololu.com/docs/0J40), sections 5.c
// to 5.e.

namespace facewire::sim {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

MaestroOptions Model(std::size_t channels) {
  MaestroOptions options;
  options.model = channels;
  return options;
}

MaestroOptions WithHomes() {
  MaestroOptions options = Model(6);
  options.channels.resize(3);
  options.channels[0].home = MaestroHome::kOff;
  options.channels[1].home = MaestroHome::kIgnore;
  options.channels[2].home = MaestroHome::kGoTo;
  options.channels[2].home_us = 1200;
  return options;
}

Bytes Target(std::uint8_t channel, unsigned quarters) {
  return {0x84, channel, static_cast<std::uint8_t>(quarters & 0x7FU),
          static_cast<std::uint8_t>(quarters >> 7U)};
}

class MaestroOnBench : public testing::Test {
 protected:
  explicit MaestroOnBench(const MaestroOptions& options = Model(6)) : bench(options) {}

  unsigned PositionQuarters(std::uint8_t channel) {
    const Bytes answer = bench.Ask({0x90, channel});
    EXPECT_EQ(answer.size(), 2U);
    return answer.size() == 2 ? answer[0] + 256U * answer[1] : 0;
  }
  unsigned Errors() {
    const Bytes answer = bench.Ask({0xA1});
    EXPECT_EQ(answer.size(), 2U);
    return answer.size() == 2 ? answer[0] + 256U * answer[1] : 0;
  }

  Bench<Maestro> bench;
};

TEST_F(MaestroOnBench, TakesTheGuidesCompactSetTarget) {
  bench.Send(Hex("84 02 70 2E"));
  EXPECT_EQ(PositionQuarters(2), 6000U);
  bench.Wait(milliseconds(40));
  EXPECT_EQ(bench.bus.Commanded(2), 1500);
}

TEST_F(MaestroOnBench, TakesTheGuidesPololuSetTarget) {
  bench.Send(Hex("AA 0C 04 00 70 2E"));
  EXPECT_EQ(PositionQuarters(0), 6000U);
}

TEST_F(MaestroOnBench, TakesTheGuidesMiniSscSetTarget) {
  bench.Send(Hex("FF 00 7F"));
  EXPECT_EQ(PositionQuarters(0), 6000U);
  bench.Send(Hex("FF 01 00"));
  EXPECT_EQ(PositionQuarters(1), 4095U);  // neutral minus the range, 1023.75 us
  bench.Send(Hex("FF 02 FE"));
  EXPECT_EQ(PositionQuarters(2), 7905U);
}

TEST_F(MaestroOnBench, TakesTheGuidesSetSpeed) {
  // Channel 5, speed 140: from 1000 us to 1350 us in 100 ms.
  bench.Send(Target(5, 4000));
  bench.Send(Hex("87 05 0C 01"));
  bench.Send(Target(5, 5400));
  bench.Wait(milliseconds(50));
  EXPECT_NEAR(PositionQuarters(5), 4700, 280);
  EXPECT_EQ(PositionQuarters(5), 5400U);
}

TEST_F(MaestroOnBench, IgnoresOtherDeviceNumbers) {
  bench.Send(Hex("AA 0D 04 00 70 2E"));
  EXPECT_EQ(PositionQuarters(0), 0U);
  EXPECT_EQ(Errors(), 0U);
}

TEST_F(MaestroOnBench, MixesTheThreeProtocols) {
  bench.Send(Hex("84 00 70 2E") + Hex("FF 01 7F") + Hex("AA 0C 04 02 70 2E"));
  for (std::uint8_t channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(PositionQuarters(channel), 6000U);
  }
}

TEST_F(MaestroOnBench, StartsWithItsPulsesOff) {
  bench.Wait(milliseconds(100));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(bench.bus.Commanded(i), 0);
    EXPECT_FALSE(bench.bus.TorqueOn(i));
  }
}

TEST_F(MaestroOnBench, TakesFortySecondsForAMillisecondAtSpeedOne) {
  bench.Send(Target(0, 4000) + Hex("87 00 01 00") + Target(0, 8000));
  bench.Wait(seconds(39));
  EXPECT_LT(PositionQuarters(0), 8000U);
  bench.Wait(seconds(1));
  EXPECT_EQ(PositionQuarters(0), 8000U);
}

TEST_F(MaestroOnBench, TakesAboutThreeSecondsForAMillisecondAtAccelerationOne) {
  bench.Send(Target(0, 4000) + Hex("89 00 01 00") + Target(0, 8000));
  bench.Wait(milliseconds(2500));
  EXPECT_LT(PositionQuarters(0), 8000U);
  bench.Wait(milliseconds(1300));
  EXPECT_EQ(PositionQuarters(0), 8000U);
}

TEST_F(MaestroOnBench, ForgetsItsPositionWhenThePulsesGoOff) {
  bench.Send(Target(0, 4000) + Hex("87 00 01 00"));
  bench.Send(Target(0, 8000));
  bench.Wait(milliseconds(100));
  EXPECT_LT(PositionQuarters(0), 4100U);
  bench.Send(Target(0, 0));
  bench.Send(Target(0, 8000));  // not speed-limited: it does not know where the servo is
  EXPECT_EQ(PositionQuarters(0), 8000U);
}

TEST_F(MaestroOnBench, LetsAServoGoTwoFramesAfterTheLastPulse) {
  bench.Send(Target(0, 6000));
  bench.Wait(milliseconds(60));
  EXPECT_TRUE(bench.bus.TorqueOn(0));
  bench.Send(Target(0, 0));
  bench.Wait(milliseconds(60));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
}

TEST_F(MaestroOnBench, ClampsATargetToTheChannelsRangeAndRecordsIt) {
  bench.Send(Target(0, 10000));
  EXPECT_EQ(PositionQuarters(0), 8000U);
  bench.Send(Target(0, 1000));
  EXPECT_EQ(PositionQuarters(0), 3968U);
  EXPECT_EQ(bench.Count(EventKind::kOutsideLimits), 2U);
}

TEST_F(MaestroOnBench, AnswersTheCommandedPulseNotTheServosPlace) {
  bench.bus.servo(0).Jam(0);
  bench.Send(Target(0, 8000));
  bench.Wait(milliseconds(500));
  EXPECT_EQ(PositionQuarters(0), 8000U);
  EXPECT_NEAR(bench.bus.Position(0), 1500, 10);
}

TEST_F(MaestroOnBench, TakesAnUnknownCommandAsAProtocolError) {
  bench.Send({0x85});
  EXPECT_EQ(Errors(), 1U << Maestro::kProtocolError);
  EXPECT_EQ(Errors(), 0U);  // reading clears
}

TEST_F(MaestroOnBench, HasNoMultipleTargetsOnTheMicro) {
  bench.Send(Hex("9F 02 03 00 00 70 2E"));
  EXPECT_EQ(Errors(), 1U << Maestro::kProtocolError);
  EXPECT_EQ(PositionQuarters(4), 0U);
}

TEST_F(MaestroOnBench, HasNoPwmOnTheMicro) {
  bench.Send(Hex("8A 00 01 00 02"));
  EXPECT_EQ(Errors(), 1U << Maestro::kProtocolError);
}

TEST_F(MaestroOnBench, RefusesAChannelThatItDoesNotHave) {
  bench.Send(Target(6, 6000));
  EXPECT_EQ(Errors(), 1U << Maestro::kProtocolError);
}

TEST_F(MaestroOnBench, HasNoSerialTimeoutFromTheWorks) {
  bench.Send(Target(0, 6000));
  bench.Wait(std::chrono::minutes(10));
  EXPECT_TRUE(bench.bus.TorqueOn(0));
  EXPECT_EQ(Errors(), 0U);
}

TEST_F(MaestroOnBench, ChangesAPulseOnlyEveryTwentyMilliseconds) {
  bench.bus.trace().KeepSamples(Trace::Keep::kEveryMillisecond);
  bench.Send(Target(0, 4000) + Hex("87 00 0A 00") + Target(0, 8000));
  bench.Wait(seconds(1));
  Time last{};
  float width = 0;
  for (const Sample& s : bench.bus.trace().samples()) {
    if (s.servo != 0 || s.commanded == width) continue;
    EXPECT_EQ((s.at - last) % milliseconds(20), Duration{});
    width = s.commanded;
    last = s.at;
  }
  EXPECT_GT(width, 1000);
}

TEST_F(MaestroOnBench, AnUnpluggedServoJumpsToItsPulseWhenItReturns) {
  bench.Send(Target(0, 4000));
  bench.Wait(seconds(1));
  bench.bus.Inject({.kind = FaultKind::kVanish,
                    .servo = 0,
                    .at = bench.now.time_since_epoch(),
                    .lasts = seconds(1)});
  bench.Wait(milliseconds(500));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  bench.Send(Target(0, 8000));
  bench.Wait(seconds(2));
  EXPECT_NEAR(bench.bus.Position(0), 2000, 15);
}

TEST_F(MaestroOnBench, TakesAnInterruptedPacketAsAProtocolErrorAndCarriesOutTheSecond) {
  bench.Send(Hex("84 01") + Hex("84 02 70 2E"));
  EXPECT_EQ(PositionQuarters(2), 6000U);
  EXPECT_EQ(PositionQuarters(1), 0U);
  EXPECT_EQ(Errors(), 1U << Maestro::kProtocolError);
}

TEST_F(MaestroOnBench, LosesTwoBytesAfterAStrayFf) {
  bench.Send(
      Hex("FF 84 02 70 2E"));  // Mini-SSC to address 84: swallowed, then data without command
  EXPECT_EQ(PositionQuarters(2), 0U);
  EXPECT_EQ(Errors(), 1U << Maestro::kProtocolError);
}

TEST_F(MaestroOnBench, AnswersOneOfThreeGetErrorsAfterAStrayFf) {
  EXPECT_THAT(bench.Ask(Hex("FF A1 A1")), IsEmpty());
  EXPECT_THAT(bench.Ask(Hex("A1")), ElementsAre(0, 0));
}

TEST_F(MaestroOnBench, SaysThatNothingMovesOnAMicroEvenWhenItDoes) {
  bench.Send(Target(0, 4000) + Hex("87 00 01 00") + Target(0, 8000));
  EXPECT_THAT(bench.Ask({0x93}), ElementsAre(0));
}

TEST_F(MaestroOnBench, BurnsAServoThatIsHeldAgainstItsStop) {
  bench.bus.servo(0).Jam(0);
  bench.Send(Target(0, 8000));
  bench.Wait(std::chrono::minutes(5));
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kBurnt, 0), 1U);
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  EXPECT_EQ(Errors(), 0U);  // the Maestro cannot know
}

class MiniOnBench : public MaestroOnBench {
 protected:
  MiniOnBench() : MaestroOnBench(Model(12)) {}
};

TEST_F(MiniOnBench, TakesTheGuidesMultipleTargets) {
  bench.Send(Target(3, 6000));
  bench.Send(Hex("9F 02 03 00 00 70 2E"));  // channel 3 off, channel 4 to neutral
  EXPECT_EQ(PositionQuarters(3), 0U);
  EXPECT_EQ(PositionQuarters(4), 6000U);
}

TEST_F(MiniOnBench, RefusesMultipleTargetsBeyondItsLastChannel) {
  bench.Send(Hex("9F 02 0B 70 2E 70 2E"));
  EXPECT_EQ(PositionQuarters(11), 0U);
  EXPECT_EQ(Errors(), 1U << Maestro::kProtocolError);
}

TEST_F(MiniOnBench, SaysWhetherAnythingMoves) {
  EXPECT_THAT(bench.Ask({0x93}), ElementsAre(0));
  bench.Send(Target(0, 4000) + Hex("87 00 01 00") + Target(0, 4400));
  EXPECT_THAT(bench.Ask({0x93}), ElementsAre(1));
  bench.Wait(seconds(5));
  EXPECT_THAT(bench.Ask({0x93}), ElementsAre(0));
}

class HomesOnBench : public MaestroOnBench {
 protected:
  HomesOnBench() : MaestroOnBench(WithHomes()) {
    bench.Send(Target(0, 6000) + Target(1, 6000) + Target(2, 6000));
  }
  void ExpectHome() {
    EXPECT_EQ(PositionQuarters(0), 0U);
    EXPECT_EQ(PositionQuarters(1), 6000U);
    EXPECT_EQ(PositionQuarters(2), 4800U);
  }
};

TEST_F(HomesOnBench, GoesHomeOnAnyError) {
  for (unsigned error = 0; error <= Maestro::kProgramCounter; ++error) {
    bench.Send(Target(0, 6000) + Target(1, 6000) + Target(2, 6000));
    bench.Wait(milliseconds(1));
    bench.bus.Raise(static_cast<Maestro::Error>(error));
    bench.Wait(milliseconds(20));
    ExpectHome();
    EXPECT_EQ(Errors(), 1U << error);
  }
}

TEST_F(HomesOnBench, GoesHomeOnCommandWithoutAnError) {
  bench.Send({0xA2});
  bench.Wait(milliseconds(20));
  ExpectHome();
  EXPECT_EQ(Errors(), 0U);
}

TEST(MaestroCrcTest, IsThatOfTheGuidesLongDivision) {
  EXPECT_EQ(MaestroCrc(Hex("83 01")), 0x17);
  // The same check byte in the maker's other guides, and a computed one.
  EXPECT_EQ(MaestroCrc(Hex("D1 01 64 00")), 0x68);
  EXPECT_EQ(MaestroCrc(Hex("84 00 70 2E")), 0x2B);
}

class CrcOnBench : public MaestroOnBench {
 protected:
  static MaestroOptions Options() {
    MaestroOptions options = Model(12);
    options.crc = true;
    return options;
  }
  CrcOnBench() : MaestroOnBench(Options()) {}
};

TEST_F(CrcOnBench, TakesAPacketWithItsCrc) {
  bench.Send(Hex("84 00 70 2E 2B"));
  bench.Wait(milliseconds(1));
  EXPECT_EQ(bench.bus.errors(), 0U);
  bench.Wait(milliseconds(40));
  EXPECT_EQ(bench.bus.Commanded(0), 1500);
}

TEST_F(CrcOnBench, RefusesAPacketWithAnotherCrc) {
  bench.Send(Hex("84 00 70 2E 2A"));
  bench.Wait(milliseconds(40));
  EXPECT_EQ(bench.bus.errors(), 1U << Maestro::kCrc);
  EXPECT_EQ(bench.bus.Commanded(0), 0);
  EXPECT_EQ(bench.Count(EventKind::kDamagedPacket), 1U);
}

TEST_F(CrcOnBench, AnswersWithoutCrcAndTakesMiniSscWithoutCrc) {
  bench.Send(Hex("FF 00 7F"));
  bench.Wait(milliseconds(40));
  EXPECT_EQ(bench.bus.Commanded(0), 1500);
  const Bytes ask = {0x90, 0x00};
  EXPECT_THAT(bench.Ask(ask + Bytes{MaestroCrc(ask)}), ElementsAre(0x70, 0x17));
}

class TimeoutOnBench : public MaestroOnBench {
 protected:
  static MaestroOptions Options() {
    MaestroOptions options = WithHomes();
    options.serial_timeout = milliseconds(500);
    return options;
  }
  TimeoutOnBench() : MaestroOnBench(Options()) {}
};

TEST_F(TimeoutOnBench, GoesHomeOnceTheHostIsSilent) {
  bench.Send(Target(0, 6000) + Target(2, 6000));
  bench.Wait(milliseconds(490));
  EXPECT_EQ(bench.bus.errors(), 0U);
  bench.Wait(milliseconds(20));
  EXPECT_EQ(bench.bus.errors(), 1U << Maestro::kTimeout);
  bench.Wait(seconds(5));
  EXPECT_EQ(bench.Count(EventKind::kWatchdog), 1U);
  EXPECT_EQ(bench.bus.Commanded(0), 0);
  EXPECT_EQ(bench.bus.Commanded(2), 1200);
}

TEST_F(TimeoutOnBench, IsFedByAnyValidCommand) {
  for (int i = 0; i < 20; ++i) {
    bench.Send({0x93});
    bench.Wait(milliseconds(400));
  }
  EXPECT_EQ(bench.bus.errors(), 0U);
}

TEST_F(TimeoutOnBench, IsNotFedByNonsense) {
  for (int i = 0; i < 4; ++i) {
    bench.Send({0x85});
    bench.Wait(milliseconds(200));
  }
  EXPECT_TRUE(bench.bus.errors() & 1U << Maestro::kTimeout);
}

TEST(MaestroPorts, FromTheWorksTheCommandPortHearsNothing) {
  MaestroOptions options = Model(6);
  options.serial_mode = MaestroOptions::SerialMode::kUartDetectBaud;
  Bench<Maestro> bench(options);
  EXPECT_THAT(bench.Ask(Hex("AA A1")), IsEmpty());
}

TEST(MaestroPorts, FromTheWorksItsPinHearsNothingBeforeTheFirstAa) {
  MaestroOptions options = Model(6);
  options.serial_mode = MaestroOptions::SerialMode::kUartDetectBaud;
  options.port = MaestroOptions::Port::kRx;
  options.baud = 115200;
  Bench<Maestro> bench(options);
  EXPECT_THAT(bench.Ask(Hex("A1")), IsEmpty());
  EXPECT_THAT(bench.Ask(Hex("AA 0C 21")), ElementsAre(0, 0));
}

TEST(MaestroPorts, WhatComesInAtTheTtlPortIsNoCommand) {
  MaestroOptions options = Model(6);
  options.port = MaestroOptions::Port::kTtlPort;
  Bench<Maestro> bench(options);
  EXPECT_THAT(bench.Ask(Hex("A1")), IsEmpty());
}

TEST(MaestroPorts, TwentyFourTargetsTakeTheTimeOfTheGuideAt115200Baud) {
  MaestroOptions options = Model(24);
  options.serial_mode = MaestroOptions::SerialMode::kUartFixed;
  options.port = MaestroOptions::Port::kRx;
  options.baud = 115200;
  Bench<Maestro> bench(options);
  // "Using the Pololu protocol": 4.6 ms.
  Bytes packet = Hex("AA 0C 1F 18 00");
  for (int i = 0; i < 24; ++i) packet = packet + Hex("70 2E");
  bench.Send(packet + Hex("90 17"));
  bench.Wait(Duration(4600 + 2 * 87 + 100));
  EXPECT_THAT(Plain(bench.bus.Transmit()), IsEmpty());
  bench.Wait(Duration(2 * 87 + 50));
  EXPECT_THAT(Plain(bench.bus.Transmit()), ElementsAre(0x70, 0x17));
}

}  // namespace
}  // namespace facewire::sim
