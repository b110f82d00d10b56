#include "core/wire/dynamixel/packet.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "core/wire/dynamixel/status.h"
#include "tests/core/wire/hex.h"

namespace facewire::wire::dynamixel {
namespace {

// Every expected packet is an example of the e-Manual's page "Protocol 2.0", under the heading of
// its instruction.
struct Context {
  std::array<std::byte, kMaxPacketBytes> out{};
};

TEST(DynamixelPacket, PingIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Ping(1, c.out)), "FF FF FD 00 01 03 00 01 19 4E");
  EXPECT_EQ(Hex(Ping(kBroadcast, c.out)), "FF FF FD 00 FE 03 00 01 31 42");
}

TEST(DynamixelPacket, ReadIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Read(1, 132, 4, c.out)), "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15");
}

TEST(DynamixelPacket, WriteIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Write(1, 116, FromHex("00 02 00 00"), c.out)),
            "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89");
}

TEST(DynamixelPacket, RebootIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Reboot(1, c.out)), "FF FF FD 00 01 03 00 08 2F 4E");
}

TEST(DynamixelPacket, SyncReadIsThatOfTheManual) {
  Context c;
  const std::array<std::uint8_t, 2> ids = {1, 2};
  EXPECT_EQ(Hex(SyncRead(132, 4, ids, c.out)), "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA");
}

TEST(DynamixelPacket, SyncWriteIsThatOfTheManual) {
  Context c;
  SyncWrite write(116, 4, c.out);
  EXPECT_TRUE(write.Add(1, FromHex("96 00 00 00")));
  EXPECT_TRUE(write.Add(2, FromHex("AA 00 00 00")));
  EXPECT_EQ(Hex(write.Finish()),
            "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87");
}

TEST(DynamixelPacket, AHeaderInTheDataIsStuffedAndCounted) {
  Context c;
  const auto packet = Write(1, 116, FromHex("FF FF FD 00"), c.out).value();
  EXPECT_EQ(Hex(packet.first(packet.size() - 2)), "FF FF FD 00 01 0A 00 03 74 00 FF FF FD FD 00");
  EXPECT_EQ(Hex(packet.last(2)),
            Hex(std::array{static_cast<std::byte>(Crc16(packet.first(15)) & 0xFFU),
                           static_cast<std::byte>(Crc16(packet.first(15)) >> 8U)}));
}

TEST(DynamixelPacket, NoHeaderEverAppearsInsideAPacket) {
  std::mt19937 random(3);
  Context c;
  for (int round = 0; round < 20'000; ++round) {
    std::vector<std::byte> data(1 + random() % 40);
    constexpr std::array kBytes = {0xFF, 0xFF, 0xFD, 0x00};
    for (std::byte& b : data) b = static_cast<std::byte>(kBytes[random() % 4]);
    const auto packet = Write(1, 10, data, c.out).value();
    const auto inside = packet.subspan(4, packet.size() - 4 - 2);
    for (std::size_t i = 0; i + 3 < inside.size(); ++i) {
      ASSERT_NE(Hex(inside.subspan(i, 4)), "FF FF FD 00") << Hex(packet);
    }
  }
}

TEST(DynamixelPacket, WhatIsNoServoOrNoDataIsRefused) {
  Context c;
  EXPECT_EQ(Ping(253, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Ping(255, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Read(kBroadcast, 0, 1, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Read(1, 0, 0, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Write(1, 0, {}, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(SyncRead(0, 1, {}, c.out).error(), Errc::kOutOfRange);
  const std::array<std::uint8_t, 1> nobody = {kBroadcast};
  EXPECT_EQ(SyncRead(0, 1, nobody, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(SyncWrite(64, 1, c.out).Finish().error(), Errc::kOutOfRange);
  SyncWrite write(64, 1, c.out);
  EXPECT_FALSE(write.Add(kBroadcast, FromHex("01")));
  EXPECT_FALSE(write.Add(1, FromHex("01 02")));
  EXPECT_TRUE(write.empty());
}

TEST(DynamixelPacket, TooSmallABufferIsSaidAndNotOverrun) {
  Context c;
  for (std::size_t size = 0; size < 10; ++size) {
    c.out.fill(std::byte{0xEE});
    EXPECT_EQ(Ping(1, std::span(c.out).first(size)).error(), Errc::kFull);
    EXPECT_EQ(c.out[size], std::byte{0xEE}) << size;
  }
  EXPECT_TRUE(Ping(1, std::span(c.out).first(10)));
  EXPECT_EQ(SyncWrite(64, 1, std::span(c.out).first(5)).Finish().error(), Errc::kOutOfRange);
}

TEST(DynamixelPacket, ASyncWriteOf64ServosFitsEvenIfAllIsStuffed) {
  Context c;
  SyncWrite write(116, 4, c.out);
  for (std::uint8_t id = 0; id < 64; ++id) {
    ASSERT_TRUE(write.Add(id, FromHex("FF FF FD FF"))) << int{id};
  }
  EXPECT_TRUE(write.Finish());
}

TEST(DynamixelPacket, AServoThatDoesNotFitIsLeftForTheNextPacket) {
  Context c;
  SyncWrite write(116, 4, std::span(c.out).first(64));
  std::uint8_t id = 0;
  while (write.Add(id, FromHex("FF FF FD FF"))) ++id;
  EXPECT_GT(id, 5);
  EXPECT_LT(id, 10);
  EXPECT_TRUE(write.Finish());
}

}  // namespace
}  // namespace facewire::wire::dynamixel
