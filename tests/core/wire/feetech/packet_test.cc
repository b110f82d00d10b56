#include "core/wire/feetech/packet.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/core/wire/hex.h"

namespace facewire::wire::feetech {
namespace {

// Expected packets are examples of Feetech's "SCS communication protocol" manual, by number.
struct Context {
  std::array<std::byte, kMaxPacketBytes> out{};
};

TEST(FeetechPacket, PingIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Ping(1, c.out)), "FF FF 01 02 01 FB");  // example 1
}

TEST(FeetechPacket, ReadIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Read(1, 0x38, 2, c.out)), "FF FF 01 04 02 38 02 BE");  // example 2
}

TEST(FeetechPacket, WriteIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Write(kBroadcast, 5, FromHex("01"), c.out)), "FF FF FE 04 03 05 01 F4");  // 3
  EXPECT_EQ(Hex(Write(1, 0x2A, FromHex("00 08 00 00 E8 03"), c.out)),
            "FF FF 01 09 03 2A 00 08 00 00 E8 03 D5");  // 4
}

TEST(FeetechPacket, SyncWriteIsThatOfTheManual) {
  Context c;
  SyncWrite write(0x2A, 6, c.out);
  for (std::uint8_t id = 1; id <= 4; ++id) {
    ASSERT_TRUE(write.Add(id, FromHex("00 08 00 00 E8 03")));
  }
  EXPECT_EQ(Hex(write.Finish()),  // example 7
            "FF FF FE 20 83 2A 06 01 00 08 00 00 E8 03 02 00 08 00 00 E8 03 03 00 08 00 00 E8 03 "
            "04 00 08 00 00 E8 03 58");
}

TEST(FeetechPacket, SyncReadIsThatOfTheManual) {
  Context c;
  const std::array<std::uint8_t, 2> ids = {1, 2};
  EXPECT_EQ(Hex(SyncRead(0x38, 8, ids, c.out)), "FF FF FE 06 82 38 08 01 02 36");  // example 8
}

TEST(FeetechPacket, RebootIsThatOfTheManual) {
  Context c;
  EXPECT_EQ(Hex(Reboot(1, c.out)), "FF FF 01 02 08 F4");  // example 13
}

TEST(FeetechPacket, ASyncWriteOfSevenBytesHolds31Servos) {
  Context c;
  SyncWrite write(41, 7, c.out);
  std::uint8_t id = 0;
  while (write.Add(id, FromHex("01 02 03 04 05 06 07"))) ++id;
  EXPECT_EQ(id, 31);
  const auto packet = write.Finish().value();
  EXPECT_EQ(packet.size(), 4U + 252U);
  EXPECT_EQ(packet[3], std::byte{252});
}

TEST(FeetechPacket, WhatIsNoServoOrNoDataIsRefused) {
  Context c;
  EXPECT_EQ(Ping(kBroadcast, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Read(1, 0, 0, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Write(255, 0, FromHex("00"), c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Write(1, 0, {}, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Write(1, 0, std::vector<std::byte>(253), c.out).error(), Errc::kOutOfRange);
  EXPECT_TRUE(Write(1, 0, std::vector<std::byte>(252), c.out));
  EXPECT_EQ(SyncRead(0, 1, {}, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(SyncWrite(40, 1, c.out).Finish().error(), Errc::kOutOfRange);
  SyncWrite write(40, 1, c.out);
  EXPECT_FALSE(write.Add(kBroadcast, FromHex("01")));
  EXPECT_FALSE(write.Add(1, FromHex("01 02")));
  EXPECT_EQ(Ping(1, std::span(c.out).first(5)).error(), Errc::kFull);
  EXPECT_EQ(SyncWrite(40, 1, std::span(c.out).first(7)).Finish().error(), Errc::kFull);
  SyncWrite small(40, 1, std::span(c.out).first(9));
  EXPECT_FALSE(small.Add(1, FromHex("01")));
}

TEST(FeetechPacket, SignsAreBitsNotComplements) {
  EXPECT_EQ(ToSignMagnitude(-100, 15), 0x8064);
  EXPECT_EQ(FromSignMagnitude(0x8064, 15), -100);
  EXPECT_EQ(FromSignMagnitude(0x0400 | 250, 10), -250);
  EXPECT_EQ(ToSignMagnitude(-5000, 10), 0x07FF);
  EXPECT_EQ(ToSignMagnitude(5000, 10), 0x03FF);
  for (int value = -32767; value <= 32767; ++value) {
    ASSERT_EQ(FromSignMagnitude(ToSignMagnitude(value, 15), 15), value);
  }
}

TEST(FeetechPacket, BothOrdersOfBytes) {
  std::array<std::byte, 2> two{};
  Put16(0x0518, ByteOrder::kLowFirst, two);
  EXPECT_EQ(Hex(two), "18 05");
  EXPECT_EQ(Get16(two, ByteOrder::kLowFirst), 1304);  // example 2's answer
  Put16(0x0518, ByteOrder::kHighFirst, two);
  EXPECT_EQ(Hex(two), "05 18");
  EXPECT_EQ(Get16(two, ByteOrder::kHighFirst), 1304);
}

}  // namespace
}  // namespace facewire::wire::feetech
