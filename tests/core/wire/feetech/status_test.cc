#include "core/wire/feetech/status.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "core/wire/feetech/packet.h"
#include "tests/core/wire/hex.h"

namespace facewire::wire::feetech {
namespace {

using Bytes = std::vector<std::byte>;
using Read = std::vector<std::string>;

// Answers of Feetech's "SCS communication protocol" manual.
constexpr const char* kPong = "FF FF 01 02 00 FC";                            // example 1
constexpr const char* kPosition = "FF FF 01 04 00 18 05 DD";                  // example 2
constexpr const char* kState1 = "FF FF 01 0A 00 00 08 00 00 00 00 79 1E 55";  // example 8
constexpr const char* kState2 = "FF FF 02 0A 00 FF 07 00 00 00 00 77 23 53";  // example 8
constexpr const char* kRead1 = "1:00 08 00 00 00 00 79 1E";
constexpr const char* kRead2 = "2:FF 07 00 00 00 00 77 23";

// A reader that asked `ids` for `parameters` bytes, and what it made of its line, as text.
struct Context {
  StatusReader reader;
  Read read;

  explicit Context(std::vector<std::uint8_t> ids, std::size_t parameters = 8) {
    EXPECT_TRUE(reader.Expect(ids, parameters));
  }
  void Push(std::span<const std::byte> bytes) {
    while (const auto status = reader.Next(bytes)) {
      std::string text = std::to_string(status->id) + ":" + Hex(status->parameters);
      if (status->errors != 0) text += " errors " + std::to_string(status->errors);
      read.push_back(text);
    }
    EXPECT_TRUE(bytes.empty());
  }
};

TEST(FeetechStatus, TheManualsAnswersAreRead) {
  Context ping({1}, 0);
  ping.Push(FromHex(kPong));
  EXPECT_EQ(ping.read, Read{"1:"});
  Context position({1}, 2);
  position.Push(FromHex(kPosition));
  EXPECT_EQ(position.read, Read{"1:18 05"});
  Context both({1, 2});
  both.Push(FromHex(kState1));
  both.Push(FromHex(kState2));
  EXPECT_EQ(both.read, (Read{kRead1, kRead2}));
  EXPECT_EQ(both.reader.stats().dropped, 0U);
}

TEST(FeetechStatus, RepliesMayBeCutAnywhere) {
  Bytes both = FromHex(kState1);
  const Bytes second = FromHex(kState2);
  both.insert(both.end(), second.begin(), second.end());
  for (std::size_t i = 0; i <= both.size(); ++i) {
    for (std::size_t j = i; j <= both.size(); ++j) {
      Context c({1, 2});
      c.Push(std::span(both).first(i));
      c.Push(std::span(both).subspan(i, j - i));
      c.Push(std::span(both).subspan(j));
      ASSERT_EQ(c.read, (Read{kRead1, kRead2})) << i << ' ' << j;
    }
  }
}

TEST(FeetechStatus, ErrorBitsAreTold) {
  Context c({1}, 0);
  c.Push(FromHex("FF FF 01 02 24 D8"));
  EXPECT_EQ(c.read, Read{"1: errors 36"});
}

TEST(FeetechStatus, AnotherLengthThanWasAskedForIsNoReply) {
  Context c({1}, 2);
  c.Push(FromHex("FF FF 01 05 00 18 05 DC"));  // says three bytes, and its sum is right
  EXPECT_TRUE(c.read.empty());
  c.Push(FromHex(kPosition));
  EXPECT_EQ(c.read, Read{"1:18 05"});
}

TEST(FeetechStatus, EachServoIsTakenOnceAndOthersNever) {
  Context c({2});
  c.Push(FromHex(kState1));
  EXPECT_TRUE(c.read.empty());
  c.Push(FromHex(kState2));
  c.Push(FromHex(kState2));
  EXPECT_EQ(c.read, Read{kRead2});
}

TEST(FeetechStatus, NothingIsTakenThatWasNotAskedFor) {
  StatusReader reader;
  const Bytes pong = FromHex(kPong);
  std::span<const std::byte> rest(pong);
  EXPECT_FALSE(reader.Next(rest));
  EXPECT_TRUE(rest.empty());
  EXPECT_EQ(reader.stats().dropped, 6U);
  EXPECT_EQ(reader.Expect({}, kMaxStatusParameters + 1).error(), Errc::kOutOfRange);
}

TEST(FeetechStatus, MissingBytesCostNoOtherReply) {
  const Bytes whole = FromHex("FF FF 01 0A 00 12 08 34 80 56 04 79 1E 35");
  for (std::size_t from = 0; from < whole.size(); ++from) {
    for (std::size_t to = from + 1; to <= whole.size(); ++to) {
      Context c({1, 2});
      c.Push(std::span(whole).first(from));
      c.Push(std::span(whole).subspan(to));
      c.Push(FromHex(kState2));
      ASSERT_EQ(c.read, Read{kRead2}) << from << ".." << to;
    }
  }
}

// Why who reads a position acts on two that agree, not on one.
TEST(FeetechStatus, ASumCannotSeeThatZerosAreMissing) {
  const Bytes whole = FromHex(kState1);
  Context c({1, 2});
  c.Push(std::span(whole).first(7));
  c.Push(std::span(whole).subspan(10));  // 00 00 00 lost; what lacks is taken from the next reply
  c.Push(FromHex(kState2));
  EXPECT_EQ(c.read, Read{"1:00 08 00 79 1E 55 FF FF"});
}

TEST(FeetechStatus, AWrongByteAnywhereIsFoundAndCostsNoOtherReply) {
  const Bytes whole = FromHex(kState1);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int wrong = 0; wrong < 256; ++wrong) {
      Bytes damaged = whole;
      if (damaged[at] == static_cast<std::byte>(wrong)) continue;
      damaged[at] = static_cast<std::byte>(wrong);
      Context c({1, 2});
      c.Push(damaged);
      ASSERT_TRUE(c.read.empty()) << at << ' ' << wrong;
      c.Push(FromHex(kState2));
      ASSERT_EQ(c.read, Read{kRead2}) << at << ' ' << wrong;
    }
  }
}

TEST(FeetechStatus, AfterAnyNoiseTheFirstSoundReplyIsDelivered) {
  std::mt19937 random(11);
  int false_replies = 0;
  constexpr int kRounds = 50'000;
  for (int round = 0; round < kRounds; ++round) {
    Bytes noise(random() % 60);
    constexpr std::array kLikely = {0xFF, 0xFF, 0x02, 0x0A, 0x00, 0x01};
    for (std::byte& b : noise) {
      b = static_cast<std::byte>(random() % 3 == 0 ? random() : kLikely[random() % 6]);
    }
    Context c({2});
    c.Push(noise);
    if (!c.read.empty()) {  // eight bits of sum let one in 256 forgeries through
      ++false_replies;
      continue;
    }
    c.Push(FromHex(kState2));
    ASSERT_EQ(c.read.size(), 1U) << Hex(noise);
    // Or the noise ends with the beginning of a forgery that swallowed the reply's own.
    if (c.read[0] != kRead2) ++false_replies;
  }
  EXPECT_LT(false_replies, kRounds / 200);
}

TEST(FeetechStatus, RandomBytesNeverGiveWhatWasNotAskedFor) {
  std::mt19937 random(12);
  StatusReader reader;
  for (int round = 0; round < 200'000; ++round) {
    const std::array<std::uint8_t, 2> ids = {static_cast<std::uint8_t>(random() % 4),
                                             static_cast<std::uint8_t>(random() % 4)};
    const std::size_t parameters = random() % 5;
    if (random() % 4 == 0) {
      ASSERT_TRUE(reader.Expect(ids, parameters));
    }
    Bytes bytes(random() % 20);
    for (std::byte& b : bytes) {
      b = static_cast<std::byte>(random() % 2 == 0 ? 0xFF : random() % 6);
    }
    std::span<const std::byte> rest(bytes);
    while (const auto status = reader.Next(rest)) {
      ASSERT_LT(status->id, 4);
      ASSERT_LT(status->parameters.size(), 5U);
    }
  }
}

TEST(FeetechStatus, AnEchoOfWhatWentToAllIsCounted) {
  Context c({1, 2});
  c.Push(FromHex("FF FF FE 06 82 38 08 01 02 36"));
  c.Push(FromHex(kState1));
  EXPECT_EQ(c.read, Read{kRead1});
  EXPECT_EQ(c.reader.stats().instructions, 1U);
}

}  // namespace
}  // namespace facewire::wire::feetech
