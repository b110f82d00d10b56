#include "tests/sim/dynamixel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim/bench.h"

// Packets in quotes are those of emanual.robotis.com/docs/en/dxl/protocol2, which shows an XM430;
// the simulated models answer a ping with their own number.

namespace facewire::sim {
namespace {

using std::chrono::seconds;
using testing::IsEmpty;

// The test's own packets, made the plain way: table-free CRC over the finished bytes.
Bytes Packet(std::uint8_t id, std::uint8_t instruction, const Bytes& params) {
  Bytes packet = {0xFF, 0xFF,       0xFD, 0x00, id, static_cast<std::uint8_t>(params.size() + 3),
                  0,    instruction};
  packet = packet + params;
  std::uint16_t crc = 0;
  for (const std::uint8_t b : packet) {
    crc = static_cast<std::uint16_t>(crc ^ (b << 8));
    for (int i = 0; i < 8; ++i) {
      crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? (crc << 1) ^ 0x8005 : crc << 1);
    }
  }
  packet.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  packet.push_back(static_cast<std::uint8_t>(crc >> 8));
  return packet;
}

Bytes Little(std::int32_t value, std::size_t size) {
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * i)));
  }
  return bytes;
}

Bytes WritePacket(std::uint8_t id, std::uint16_t address, std::int32_t value, std::size_t size) {
  return Packet(id, 0x03, Little(address, 2) + Little(value, size));
}
Bytes ReadPacket(std::uint8_t id, std::uint16_t address, std::uint8_t size) {
  return Packet(id, 0x02, Little(address, 2) + Bytes{size, 0});
}

DynamixelOptions Chain(std::vector<std::uint8_t> ids, const DynamixelModel& model = Xl330()) {
  DynamixelOptions options(model);
  options.ids = std::move(ids);
  options.baud = 1'000'000;
  return options;
}

class DynamixelOnBench : public testing::Test {
 protected:
  explicit DynamixelOnBench(const DynamixelOptions& options = Chain({1, 2})) : bench(options) {}

  // The error byte of the answer to a write; -1 without an answer.
  int Write(std::uint8_t id, std::uint16_t address, std::int32_t value, std::size_t size) {
    const Bytes answer = bench.Ask(WritePacket(id, address, value, size));
    return answer.size() == 11 ? answer[8] : -1;
  }
  std::int32_t Entry(std::uint16_t address, std::size_t servo = 0) {
    return bench.bus.Entry(servo, address);
  }
  void TorqueOn(std::uint8_t id = 1) { EXPECT_EQ(Write(id, 64, 1, 1), 0); }

  Bench<Dynamixel> bench;
};

TEST_F(DynamixelOnBench, AnswersTheManualsPing) {
  // "FF FF FD 00 01 03 00 01 19 4E"; the model number 1200 is 04B0.
  const Bytes answer = bench.Ask(Hex("FF FF FD 00 01 03 00 01 19 4E"));
  EXPECT_EQ(answer, Packet(1, 0x55, Hex("00 B0 04 34")));
}

TEST_F(DynamixelOnBench, AnswersThePingOfTheManualByteForByteAsTheManualsServo) {
  bench.bus.SetEntry(0, 0, 1030);
  bench.bus.SetEntry(0, 6, 38);
  bench.bus.SetEntry(1, 0, 1030);
  bench.bus.SetEntry(1, 6, 38);
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 03 00 01 19 4E")),
            Hex("FF FF FD 00 01 07 00 55 00 06 04 26 65 5D"));
  // The broadcast ping, and both answers in the order of the ids.
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 FE 03 00 01 31 42")),
            Hex("FF FF FD 00 01 07 00 55 00 06 04 26 65 5D") +
                Hex("FF FF FD 00 02 07 00 55 00 06 04 26 6F 6D"));
}

TEST_F(DynamixelOnBench, AnswersTheManualsWrite) {
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89")),
            Hex("FF FF FD 00 01 04 00 55 00 A1 0C"));
  EXPECT_EQ(Entry(dynamixel::kGoalPosition), 512);
}

TEST_F(DynamixelOnBench, AnswersTheManualsRegWriteAndAction) {
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 09 00 04 68 00 C8 00 00 00 AE 8E")),
            Hex("FF FF FD 00 01 04 00 55 00 A1 0C"));
  EXPECT_EQ(Entry(dynamixel::kRegistered), 1);
  EXPECT_EQ(Entry(dynamixel::kGoalVelocity), 0);
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 03 00 05 02 CE")),
            Hex("FF FF FD 00 01 04 00 55 00 A1 0C"));
  EXPECT_EQ(Entry(dynamixel::kRegistered), 0);
  EXPECT_EQ(Entry(dynamixel::kGoalVelocity), 200);
  // Without a registered write it is an instruction error.
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 03 00 05 02 CE"))[8], 2);
}

TEST_F(DynamixelOnBench, TakesTheManualsSyncWriteWithoutAnAnswer) {
  EXPECT_THAT(
      bench.Ask(Hex("FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87")),
      IsEmpty());
  EXPECT_EQ(Entry(dynamixel::kGoalPosition, 0), 150);
  EXPECT_EQ(Entry(dynamixel::kGoalPosition, 1), 170);
}

TEST_F(DynamixelOnBench, TakesTheManualsBulkWriteAndRefusesWhatIsBeyondTheModelsRange) {
  bench.Ask(Hex("FF FF FD 00 FE 10 00 93 01 20 00 02 00 A0 00 02 1F 00 01 00 50 B7 68"));
  EXPECT_EQ(Entry(dynamixel::kMaxVoltage, 0), 70);  // 16 V are too many for this model
  EXPECT_EQ(Entry(dynamixel::kTemperatureLimit, 1), 80);
}

TEST_F(DynamixelOnBench, AnswersTheManualsReboot) {
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 03 00 08 2F 4E")),
            Hex("FF FF FD 00 01 04 00 55 00 A1 0C"));
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kReboot, 0), 1U);
  EXPECT_THAT(bench.Ask(Packet(1, 0x01, {})), IsEmpty());  // it is starting
  bench.Wait(seconds(1));
  EXPECT_FALSE(bench.Ask(Packet(1, 0x01, {})).empty());
}

TEST_F(DynamixelOnBench, RecordsTheManualsFactoryReset) {
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 04 00 06 01 A1 E6")),
            Hex("FF FF FD 00 01 04 00 55 00 A1 0C"));
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kFactoryReset, 0), 1U);
  bench.bus.SetEntry(0, dynamixel::kBaudRate, 3);
  bench.Wait(seconds(1));
  EXPECT_EQ(Entry(dynamixel::kId), 1);
}

TEST_F(DynamixelOnBench, DoesNotResetAllServosAtOnce) {
  bench.Ask(Packet(0xFE, 0x06, {0xFF}));
  EXPECT_EQ(bench.Count(EventKind::kFactoryReset), 0U);
}

TEST_F(DynamixelOnBench, TakesTheManualsClear) {
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC")),
            Hex("FF FF FD 00 01 04 00 55 00 A1 0C"));
}

TEST(DynamixelReads, AnswersTheManualsReadAndSyncReadInTheOrderOfTheList) {
  DynamixelOptions options = Chain({1, 2});
  options.poses = {166, 2079};
  options.servo.sensor_noise_rad = 0;
  Bench<Dynamixel> bench(options);
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 01 07 00 02 84 00 04 00 1D 15")),
            Hex("FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0"));
  EXPECT_EQ(bench.Ask(Hex("FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA")),
            Hex("FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0") +
                Hex("FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE"));
}

TEST(DynamixelReads, AnswersTheManualsBulkRead) {
  DynamixelOptions options = Chain({1, 2}, Xl430());
  options.supply_V = 11.91;
  Bench<Dynamixel> bench(options);
  bench.bus.servo(1).Heat(36.3);
  EXPECT_EQ(
      bench.Ask(Hex("FF FF FD 00 FE 0D 00 92 01 90 00 02 00 02 92 00 01 00 1A 05")),
      Hex("FF FF FD 00 01 06 00 55 00 77 00 C3 69") + Hex("FF FF FD 00 02 05 00 55 00 24 8B A9"));
}

TEST_F(DynamixelOnBench, WaitsItsReturnDelayBeforeItAnswers) {
  bench.Send(ReadPacket(1, 132, 4));
  // 14 bytes of 10 us, 250 times 2 us, 20 us of its own, the first byte.
  bench.Wait(Duration(140 + 500 + 20 + 9));
  EXPECT_THAT(Plain(bench.bus.Transmit()), IsEmpty());
  bench.Wait(Duration(1));
  EXPECT_EQ(Plain(bench.bus.Transmit()).size(), 1U);
  bench.Wait(Duration(140));
  EXPECT_EQ(Plain(bench.bus.Transmit()).size(), 14U);
}

TEST_F(DynamixelOnBench, TellsADamagedPacketByItsCrcError) {
  Bytes packet = ReadPacket(1, 132, 4);
  packet.back() ^= 1;
  EXPECT_EQ(bench.Ask(packet)[8], 3);
  EXPECT_EQ(bench.Count(EventKind::kDamagedPacket), 1U);
}

TEST_F(DynamixelOnBench, SaysWhatIsWrongWithAWrite) {
  EXPECT_EQ(Write(1, 116, 4096, 4), 6);  // beyond Max Position Limit
  EXPECT_EQ(Write(1, 116, 512, 2), 5);   // half an entry
  EXPECT_EQ(Write(1, 132, 512, 4), 7);   // read-only
  EXPECT_EQ(Write(1, 15, 1, 1), 7);      // nothing there
  EXPECT_EQ(Write(1, 64, 2, 1), 4);      // beyond its range
  EXPECT_EQ(bench.Ask(Packet(1, 0x77, {}))[8], 2);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kOutsideLimits, 0), 1U);
}

TEST_F(DynamixelOnBench, LocksItsEepromWhileItHasTorque) {
  EXPECT_EQ(Write(1, 48, 3000, 4), 0);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kEepromWrite, 0), 1U);
  TorqueOn();
  EXPECT_EQ(Write(1, 48, 3500, 4), 7);
  EXPECT_EQ(Entry(48), 3000);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kEepromTry, 0), 1U);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kEepromWrite, 0), 1U);
}

TEST_F(DynamixelOnBench, AnswersAsItsStatusReturnLevelSays) {
  EXPECT_EQ(Write(1, 68, 1, 1), -1);
  EXPECT_EQ(bench.Ask(ReadPacket(1, 132, 4)).size(), 15U);
  EXPECT_EQ(Write(1, 68, 0, 1), -1);
  EXPECT_THAT(bench.Ask(ReadPacket(1, 132, 4)), IsEmpty());
  EXPECT_FALSE(bench.Ask(Packet(1, 0x01, {})).empty());
}

TEST_F(DynamixelOnBench, StuffsAndUnstuffs) {
  bench.bus.SetEntry(0, dynamixel::kMinPosition, 0);
  // Min Position Limit is FF FF FD 00 in this packet: an impossible value, but well stuffed.
  Bytes packet = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x0A, 0x00, 0x03,
                  0x34, 0x00, 0xFF, 0xFF, 0xFD, 0xFD, 0x00};
  Bytes whole = Packet(1, 0x03, Bytes(packet.begin() + 8, packet.end()));
  EXPECT_EQ(bench.Ask(whole)[8], 4);
  bench.bus.SetEntry(0, dynamixel::kGoalPosition, 0x00FDFFFF);
  const Bytes answer = bench.Ask(ReadPacket(1, 116, 4));
  EXPECT_EQ(answer, Packet(1, 0x55, Hex("00 FF FF FD FD 00")));
}

TEST_F(DynamixelOnBench, FindsAPacketAfterNoiseThatLooksLikeItsStart) {
  const Bytes answer = bench.Ask(Hex("00 FF FF FF") + Packet(1, 0x01, {}));
  EXPECT_EQ(answer.size(), 14U);
}

TEST_F(DynamixelOnBench, ForgetsHalfAPacketAfterAPause) {
  bench.Send(Hex("FF FF FD 00 01 50 00"));
  bench.Wait(milliseconds(200));
  EXPECT_EQ(bench.Ask(Packet(1, 0x01, {})).size(), 14U);
}

TEST_F(DynamixelOnBench, GoesToAnOldGoalWhenTheTorqueComesOn) {
  EXPECT_EQ(Write(1, 116, 1000, 4), 0);
  EXPECT_NEAR(bench.bus.Position(0), 2048, 4);
  TorqueOn();
  bench.Wait(seconds(1));
  EXPECT_NEAR(bench.bus.Position(0), 1000, 4);
}

TEST_F(DynamixelOnBench, HoldsItsPlaceWhenTheTorqueComesOnBeforeAnyGoal) {
  TorqueOn();
  bench.Wait(seconds(1));
  EXPECT_NEAR(bench.bus.Position(0), 2048, 4);
}

TEST(DynamixelThatHolds, ForgetsAnOldGoalWhenTheTorqueComesOn) {
  DynamixelOptions options = Chain({1});
  options.holds_at_torque_on = true;
  Bench<Dynamixel> bench(options);
  bench.Ask(WritePacket(1, 116, 1000, 4));
  bench.Ask(WritePacket(1, 64, 1, 1));
  bench.Wait(seconds(1));
  EXPECT_NEAR(bench.bus.Position(0), 2048, 4);
  EXPECT_NEAR(bench.bus.Goal(0), 2048, 2);
}

TEST_F(DynamixelOnBench, GoesToItsGoalWithItsProfile) {
  TorqueOn();
  EXPECT_EQ(Write(1, 108, 10, 4), 0);
  EXPECT_EQ(Write(1, 112, 100, 4), 0);  // 22.9 rpm: 1563 counts a second
  EXPECT_EQ(Write(1, 116, 3048, 4), 0);
  const double seconds_taken = std::chrono::duration<double>(bench.TimeTo(0, 3040)).count();
  EXPECT_NEAR(seconds_taken, 1000 / 1563.3 + 0.64, 0.1);
}

TEST_F(DynamixelOnBench, TakesTheTimeThatATimedProfileSays) {
  EXPECT_EQ(Write(1, 10, 4, 1), 0);
  TorqueOn();
  EXPECT_EQ(Write(1, 108, 200, 4), 0);
  EXPECT_EQ(Write(1, 112, 1000, 4), 0);
  EXPECT_EQ(Write(1, 116, 2548, 4), 0);
  EXPECT_NEAR(std::chrono::duration<double>(bench.TimeTo(0, 2543)).count(), 1.0, 0.15);
}

TEST_F(DynamixelOnBench, ReversesItsDirection) {
  EXPECT_EQ(Write(1, 10, 1, 1), 0);
  TorqueOn();
  EXPECT_EQ(Write(1, 116, 3048, 4), 0);
  bench.Wait(seconds(2));
  EXPECT_NEAR(bench.bus.Position(0), 1048, 5);
  EXPECT_NEAR(Entry(dynamixel::kPresentPosition), 3048, 5);
}

TEST_F(DynamixelOnBench, ShowsWhatItMeasures) {
  TorqueOn();
  EXPECT_EQ(Write(1, 112, 100, 4), 0);
  bench.Send(WritePacket(1, 116, 4000, 4));
  bench.Wait(milliseconds(500));
  EXPECT_NEAR(Entry(dynamixel::kPresentVelocity), 100, 8);
  EXPECT_EQ(Entry(dynamixel::kMoving), 1);
  EXPECT_EQ(Entry(dynamixel::kPresentTemperature), 25);
  EXPECT_NEAR(Entry(dynamixel::kPresentVoltage), 50, 1);
  EXPECT_GT(Entry(dynamixel::kPresentCurrent), 50);
}

class WatchdogOnBench : public DynamixelOnBench {
 protected:
  // The manual's example: velocity mode, torque, velocity 50, watchdog 100 (2 s).
  WatchdogOnBench() {
    EXPECT_EQ(Write(1, 11, 1, 1), 0);
    TorqueOn();
    EXPECT_EQ(Write(1, 104, 50, 4), 0);
    EXPECT_EQ(Write(1, 98, 100, 1), 0);
  }
};

TEST_F(WatchdogOnBench, StopsTheServoAndLocksItsGoals) {
  bench.Wait(milliseconds(1900));
  EXPECT_NEAR(Entry(dynamixel::kPresentVelocity), 50, 5);
  bench.Wait(milliseconds(300));
  EXPECT_NEAR(Entry(dynamixel::kPresentVelocity), 0, 1);
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kWatchdog, 0), 1U);
  const Bytes answer = bench.Ask(ReadPacket(1, 98, 1));
  EXPECT_EQ(answer[9], 0xFF);
  EXPECT_EQ(Write(1, 104, 150, 4), 4);  // Data Range Error
  EXPECT_EQ(Write(1, 116, 2000, 4), 4);
  EXPECT_EQ(Write(1, 98, 0, 1), 0);
  EXPECT_EQ(Write(1, 104, 150, 4), 0);
  bench.Wait(milliseconds(500));
  EXPECT_NEAR(Entry(dynamixel::kPresentVelocity), 150, 8);
}

TEST_F(WatchdogOnBench, IsFedByAnyInstructionToAnyServo) {
  for (int i = 0; i < 5; ++i) {
    bench.Ask(Packet(2, 0x01, {}));
    bench.Wait(milliseconds(1500));
  }
  EXPECT_EQ(bench.Count(EventKind::kWatchdog), 0U);
}

TEST_F(WatchdogOnBench, IsNotFedByADamagedPacket) {
  Bytes packet = Packet(2, 0x01, {});
  packet.back() ^= 1;
  bench.Wait(milliseconds(1500));
  bench.Ask(packet);
  bench.Wait(milliseconds(600));
  EXPECT_EQ(bench.Count(EventKind::kWatchdog), 1U);
}

TEST_F(WatchdogOnBench, SleepsWithoutTorque) {
  EXPECT_EQ(Write(1, 64, 0, 1), 0);
  bench.Wait(seconds(5));
  EXPECT_EQ(bench.Count(EventKind::kWatchdog), 0U);
}

TEST_F(DynamixelOnBench, HoldsItsPlaceInPositionModeWhenItsWatchdogTrips) {
  TorqueOn();
  EXPECT_EQ(Write(1, 112, 50, 4), 0);
  EXPECT_EQ(Write(1, 98, 5, 1), 0);
  bench.Send(WritePacket(1, 116, 3500, 4));
  bench.Wait(milliseconds(300));
  const double here = bench.bus.Position(0);
  EXPECT_GT(here, 2060);
  EXPECT_LT(here, 2400);
  bench.Wait(seconds(3));
  EXPECT_NEAR(bench.bus.Position(0), here, 6);
  EXPECT_TRUE(bench.bus.TorqueOn(0));
}

TEST_F(DynamixelOnBench, GoesFreeInCurrentModeWhenItsWatchdogTrips) {
  EXPECT_EQ(Write(1, 11, 0, 1), 0);
  TorqueOn();
  EXPECT_EQ(Write(1, 98, 5, 1), 0);
  EXPECT_EQ(Write(1, 102, 300, 2), 0);
  EXPECT_GT(bench.bus.servo(0).current_A(), 0.1);
  bench.Wait(seconds(1));
  EXPECT_NEAR(bench.bus.servo(0).current_A(), 0, 0.001);
}

TEST_F(DynamixelOnBench, LimitsItsCurrentInCurrentBasedPositionMode) {
  EXPECT_EQ(Write(1, 11, 5, 1), 0);
  TorqueOn();
  EXPECT_EQ(Write(1, 102, 200, 2), 0);
  bench.bus.servo(0).Jam(0);
  EXPECT_EQ(Write(1, 116, 4000, 4), 0);
  bench.Wait(seconds(3));
  EXPECT_NEAR(bench.bus.servo(0).current_A(), 0.2, 0.001);
  EXPECT_EQ(Entry(dynamixel::kHardwareError), 0);
}

TEST(DynamixelSupply, ShutsDownWhenItsVoltageIsTooLow) {
  DynamixelOptions options = Chain({1});
  options.supply_V = 3.35;
  Bench<Dynamixel> bench(options);
  bench.Wait(seconds(1));
  EXPECT_EQ(bench.bus.Entry(0, dynamixel::kHardwareError), 1 << dynamixel::kVoltageBit);
  bench.Ask(WritePacket(1, 64, 1, 1));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
}

TEST_F(DynamixelOnBench, ShutsDownOnOverloadUntilItIsRebooted) {
  TorqueOn();
  bench.bus.servo(0).Jam(0);
  EXPECT_EQ(Write(1, 116, 4000, 4), 0);
  bench.Wait(milliseconds(1300));
  EXPECT_TRUE(bench.bus.TorqueOn(0));
  bench.Wait(milliseconds(400));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  EXPECT_EQ(Entry(dynamixel::kHardwareError), 1 << dynamixel::kOverloadBit);
  // The alert rides on every answer, also a good one; no torque before a reboot.
  EXPECT_EQ(Write(1, 64, 1, 1), 0x80);
  EXPECT_EQ(Entry(dynamixel::kTorqueEnable), 0);
  EXPECT_EQ(bench.Ask(ReadPacket(1, 70, 1))[8], 0x80);
  bench.Ask(Packet(1, 0x08, {}));
  bench.Wait(seconds(1));
  TorqueOn();
}

TEST_F(DynamixelOnBench, ShutsDownWhenItIsHotterThanItsLimit) {
  TorqueOn();
  bench.bus.servo(0).Heat(71);
  bench.Wait(milliseconds(5));
  EXPECT_FALSE(bench.bus.TorqueOn(0));
  EXPECT_EQ(Entry(dynamixel::kHardwareError), 1 << dynamixel::kHeatBit);
  // Still hot after the reboot: at once again.
  bench.Ask(Packet(1, 0x08, {}));
  bench.Wait(seconds(1));
  EXPECT_EQ(bench.bus.trace().Count(EventKind::kOverheated, 0), 2U);
}

TEST_F(DynamixelOnBench, ShowsAnErrorThatIsNotInItsShutdownMaskAndWorksOn) {
  EXPECT_EQ(Write(1, 63, 0x30, 1), 0);
  TorqueOn();
  bench.bus.servo(0).Heat(71);
  bench.Wait(milliseconds(5));
  EXPECT_TRUE(bench.bus.TorqueOn(0));
  EXPECT_EQ(Write(1, 116, 2100, 4), 0x80);
}

TEST_F(DynamixelOnBench, StaysSilentBehindAMissingServoInASyncRead) {
  bench.bus.Inject({.kind = FaultKind::kMute, .servo = 0, .lasts = seconds(1)});
  bench.Wait(milliseconds(5));
  EXPECT_THAT(bench.Ask(Packet(0xFE, 0x82, Hex("84 00 04 00 01 02"))), IsEmpty());
  EXPECT_EQ(bench.Ask(Packet(0xFE, 0x82, Hex("84 00 04 00 02 01"))).size(), 15U);
}

TEST_F(DynamixelOnBench, DamagesBothWhenTheHostTalksIntoAReply) {
  bench.Send(ReadPacket(1, 132, 4));
  bench.Wait(Duration(700));  // it is answering
  bench.Send(WritePacket(2, 116, 3000, 4));
  bench.Wait(milliseconds(5));
  EXPECT_GE(bench.Count(EventKind::kCollision), 1U);
  EXPECT_NE(Plain(bench.bus.Transmit()), Packet(1, 0x55, Bytes{0} + Little(Entry(132), 4)));
  EXPECT_NE(Entry(dynamixel::kGoalPosition, 1), 3000);
}

TEST_F(DynamixelOnBench, AnswersNothingAtAnotherBaudRate) {
  EXPECT_EQ(Write(1, 8, 1, 1), 0);  // takes effect with the next packet
  EXPECT_THAT(bench.Ask(Packet(1, 0x01, {})), IsEmpty());
}

TEST(DynamixelSupply, SagsUnderTheSumOfCurrentsAndServosStartAnew) {
  DynamixelOptions options = Chain({1, 2, 3, 4});
  options.supply_ohm = 0.6;
  Bench<Dynamixel> bench(options);
  for (std::uint8_t id = 1; id <= 4; ++id) {
    bench.Ask(WritePacket(id, 64, 1, 1));
    bench.bus.servo(id - 1U).Jam(0);
    bench.Ask(WritePacket(id, 116, 4000, 4), milliseconds(2));
  }
  bench.Wait(milliseconds(100));
  EXPECT_GE(bench.Count(EventKind::kBrownOut), 1U);
  EXPECT_FALSE(bench.bus.TorqueOn(0) && bench.bus.TorqueOn(1) && bench.bus.TorqueOn(2) &&
               bench.bus.TorqueOn(3));
}

}  // namespace
}  // namespace facewire::sim
