#include "core/wire/maestro/maestro.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/core/wire/hex.h"

namespace facewire::wire::maestro {
namespace {

// Examples of Pololu's user's guide (0J40) are named by its sections.
struct Context {
  std::array<std::byte, kMaxPacketBytes> out{};
  Encoder compact;
  Encoder pololu{{.pololu = true}};
  Encoder checked{{.crc = true}};
};

TEST(Maestro, SetsATargetAsInTheGuide) {
  Context c;
  EXPECT_EQ(Hex(c.compact.SetTarget(0, 6000, c.out)), "84 00 70 2E");       // 5.c, 1500 us
  EXPECT_EQ(Hex(c.compact.SetTarget(2, 6000, c.out)), "84 02 70 2E");       // 5.e
  EXPECT_EQ(Hex(c.pololu.SetTarget(0, 6000, c.out)), "AA 0C 04 00 70 2E");  // 5.c
}

TEST(Maestro, SetsSeveralTargetsAsInTheGuide) {
  Context c;  // 5.e: channel 3 off, channel 4 at neutral
  const std::array<std::uint16_t, 2> targets = {0, 6000};
  EXPECT_EQ(Hex(c.compact.SetTargets(3, targets, c.out)), "9F 02 03 00 00 70 2E");
}

TEST(Maestro, SetsSpeedAsInTheGuide) {
  Context c;
  EXPECT_EQ(Hex(c.compact.SetSpeed(5, 140, c.out)), "87 05 0C 01");  // 5.e
}

TEST(Maestro, OtherCommandsHaveTheGuidesNumbers) {
  Context c;
  EXPECT_EQ(Hex(c.compact.SetAcceleration(1, 255, c.out)), "89 01 7F 01");
  EXPECT_EQ(Hex(c.compact.GetPosition(7, c.out)), "90 07");
  EXPECT_EQ(Hex(c.compact.GetMovingState(c.out)), "93");
  EXPECT_EQ(Hex(c.compact.GetErrors(c.out)), "A1");
  EXPECT_EQ(Hex(c.compact.GoHome(c.out)), "A2");
  EXPECT_EQ(Hex(c.pololu.GetErrors(c.out)), "AA 0C 21");
  EXPECT_EQ(Hex(MiniSsc(2, 254, c.out)), "FF 02 FE");
}

TEST(Maestro, TheCrcIsThatOfTheGuide) {
  EXPECT_EQ(Crc7(FromHex("83 01")), 0x17);        // 5.d, worked by hand there
  EXPECT_EQ(Crc7(FromHex("D1 01 64 00")), 0x68);  // published for the same CRC by Pololu
  Context c;
  EXPECT_EQ(Hex(c.checked.SetTarget(0, 6000, c.out)), "84 00 70 2E 2B");
}

TEST(Maestro, APacketOfAllChannelsJustFits) {
  Context c;
  const Encoder all({.pololu = true, .device = 127, .crc = true});
  const std::vector<std::uint16_t> targets(kMaxChannels, kMaxValue);
  EXPECT_EQ(all.SetTargets(0, targets, c.out).value().size(), kMaxPacketBytes);
  EXPECT_EQ(all.SetTargets(0, targets, std::span(c.out).first(kMaxPacketBytes - 1)).error(),
            Errc::kFull);
}

TEST(Maestro, WhatAPacketCannotCarryIsRefused) {
  Context c;
  EXPECT_EQ(c.compact.SetTarget(kMaxChannels, 0, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(c.compact.SetTarget(0, kMaxValue + 1, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(c.compact.SetAcceleration(0, 256, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(c.compact.GetPosition(kMaxChannels, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(c.compact.SetTargets(0, {}, c.out).error(), Errc::kOutOfRange);
  const std::array<std::uint16_t, 2> two = {1, kMaxValue + 1};
  EXPECT_EQ(c.compact.SetTargets(23, two, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(c.compact.SetTargets(0, two, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(Encoder({.device = 128}).GoHome(c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(MiniSsc(0, 255, c.out).error(), Errc::kOutOfRange);
  EXPECT_EQ(MiniSsc(0, 0, std::span(c.out).first(2)).error(), Errc::kFull);
  EXPECT_EQ(c.compact.GoHome({}).error(), Errc::kFull);
}

TEST(Maestro, OnlyTheFirstByteOfACommandHasItsTopBitSet) {
  std::mt19937 random(1);
  Context c;
  for (int round = 0; round < 10'000; ++round) {
    const auto channel = static_cast<std::uint8_t>(random() % kMaxChannels);
    const auto target = static_cast<std::uint16_t>(random() % (kMaxValue + 1U));
    for (const Encoder* encoder : {&c.compact, &c.pololu, &c.checked}) {
      const auto packet = encoder->SetTarget(channel, target, c.out).value();
      ASSERT_NE(packet[0] & std::byte{0x80}, std::byte{0});
      for (std::byte b : packet.subspan(1)) ASSERT_EQ(b & std::byte{0x80}, std::byte{0});
    }
  }
}

TEST(Maestro, EveryErrorHasItsName) {
  std::set<std::string> names;
  for (unsigned bit = 0; bit < 9; ++bit) {
    names.insert(Name(static_cast<Error>(1U << bit)));
  }
  EXPECT_EQ(names.size(), 9U);
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_STREQ(Name(static_cast<Error>(1U << 9U)), "unknown");
}

// A reply's value, or what went wrong.
std::string Read(ReplyReader& reader, std::string_view hex) {
  const auto bytes = FromHex(hex);
  std::span<const std::byte> rest(bytes);
  const auto value = reader.Next(rest);
  return value ? std::to_string(*value) : Name(value.error());
}

TEST(MaestroReplies, AreReadHoweverTheyAreCut) {
  ReplyReader reader;
  reader.Expect(Reply::kPosition);
  EXPECT_EQ(Read(reader, "70 17"), "6000");  // 5.e: position is low byte, high byte, all 8 bits
  reader.Expect(Reply::kPosition);
  EXPECT_EQ(Read(reader, "70"), "not ready");
  EXPECT_EQ(Read(reader, ""), "not ready");
  EXPECT_EQ(Read(reader, "17"), "6000");
  reader.Expect(Reply::kMovingState);
  EXPECT_EQ(Read(reader, "01"), "1");
  reader.Expect(Reply::kErrors);
  EXPECT_EQ(Read(reader, "20 00"), "32");
}

TEST(MaestroReplies, WhatNobodyAskedForIsDropped) {
  ReplyReader reader;
  EXPECT_EQ(Read(reader, "01 02 03"), "not ready");
  EXPECT_EQ(reader.stray(), 3U);
  reader.Expect(Reply::kMovingState);
  EXPECT_EQ(Read(reader, "00"), "0");
  EXPECT_EQ(Read(reader, "00"), "not ready");
  EXPECT_EQ(reader.stray(), 4U);
}

TEST(MaestroReplies, HalfAReplyIsForgottenWithTheNextQuestion) {
  ReplyReader reader;
  reader.Expect(Reply::kPosition);
  EXPECT_EQ(Read(reader, "70"), "not ready");
  reader.Expect(Reply::kPosition);
  EXPECT_EQ(Read(reader, "40 1F"), "8000");
}

TEST(MaestroReplies, WhatNoBoardSendsIsCorrupt) {
  ReplyReader reader;
  reader.Expect(Reply::kMovingState);
  EXPECT_EQ(Read(reader, "02"), "corrupt");
  reader.Expect(Reply::kErrors);
  EXPECT_EQ(Read(reader, "00 02"), "corrupt");
  reader.Expect(Reply::kPosition);
  EXPECT_EQ(Read(reader, "00 40"), "corrupt");
  EXPECT_EQ(Read(reader, "00"), "not ready");  // and the reader is idle again
  EXPECT_EQ(reader.stray(), 1U);
}

TEST(MaestroReplies, RandomBytesGiveOnlyWhatABoardCanSay) {
  std::mt19937 random(7);
  ReplyReader reader;
  for (int round = 0; round < 100'000; ++round) {
    if (random() % 3 == 0) reader.Expect(static_cast<Reply>(random() % 4));
    const Reply expected = reader.expected();
    std::array<std::byte, 3> bytes{};
    for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    std::span<const std::byte> rest = std::span(bytes).first(random() % 4);
    const auto value = reader.Next(rest);
    if (!value) continue;
    ASSERT_NE(expected, Reply::kNone);
    ASSERT_LE(*value, expected == Reply::kMovingState ? 1
                      : expected == Reply::kErrors    ? kErrorMask
                                                      : kMaxValue);
  }
}

}  // namespace
}  // namespace facewire::wire::maestro
