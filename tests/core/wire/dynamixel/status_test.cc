#include "core/wire/dynamixel/status.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "core/wire/dynamixel/packet.h"
#include "tests/core/wire/hex.h"

namespace facewire::wire::dynamixel {
namespace {

using Bytes = std::vector<std::byte>;

// Examples of the e-Manual's page "Protocol 2.0".
constexpr const char* kPong = "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D";          // Ping
constexpr const char* kPosition1 = "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0";  // Sync Read
constexpr const char* kPosition2 = "FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE";  // Sync Read
constexpr const char* kDone = "FF FF FD 00 01 04 00 55 00 A1 0C";                   // Write

// A second, plain way to make a status packet.
Bytes MakeStatus(int id, int error, const Bytes& parameters) {
  Bytes inside = {std::byte{0x55}, static_cast<std::byte>(error)};
  for (std::byte b : parameters) {
    inside.push_back(b);
    const std::size_t n = inside.size();
    if (n >= 3 && b == std::byte{0xFD} && inside[n - 2] == std::byte{0xFF} &&
        inside[n - 3] == std::byte{0xFF}) {
      inside.push_back(std::byte{0xFD});
    }
  }
  Bytes packet = FromHex("FF FF FD 00");
  packet.push_back(static_cast<std::byte>(id));
  packet.push_back(static_cast<std::byte>((inside.size() + 2) & 0xFFU));
  packet.push_back(static_cast<std::byte>((inside.size() + 2) >> 8U));
  packet.insert(packet.end(), inside.begin(), inside.end());
  const std::uint16_t crc = Crc16(packet);
  packet.push_back(static_cast<std::byte>(crc & 0xFFU));
  packet.push_back(static_cast<std::byte>(crc >> 8U));
  return packet;
}

// What a reader made of its line, as text: "1:A6 00 00 00".
struct Context {
  StatusReader reader;
  std::vector<std::string> read;

  void Push(std::span<const std::byte> bytes) {
    while (const auto status = reader.Next(bytes)) {
      std::string text = std::to_string(status->id) + ":" + Hex(status->parameters);
      if (status->alert) text += " alert";
      if (status->error != StatusError::kNone) text += std::string(" ") + Name(status->error);
      read.push_back(text);
    }
    EXPECT_TRUE(bytes.empty());
  }
};
using Read = std::vector<std::string>;

TEST(DynamixelStatus, TheManualsExamplesAreRead) {
  Context c;
  for (const char* packet : {kPong, kPosition1, kPosition2, kDone}) c.Push(FromHex(packet));
  EXPECT_EQ(c.read, (Read{"1:06 04 26", "1:A6 00 00 00", "2:1F 08 00 00", "1:"}));
  EXPECT_EQ(c.reader.stats().packets, 4U);
  EXPECT_EQ(c.reader.stats().damaged, 0U);
}

TEST(DynamixelStatus, RepliesMayBeCutAnywhere) {
  Bytes both = FromHex(kPosition1);
  const Bytes second = FromHex(kPosition2);
  both.insert(both.end(), second.begin(), second.end());
  for (std::size_t i = 0; i <= both.size(); ++i) {
    for (std::size_t j = i; j <= both.size(); ++j) {
      Context c;
      c.Push(std::span(both).first(i));
      c.Push(std::span(both).subspan(i, j - i));
      c.Push(std::span(both).subspan(j));
      ASSERT_EQ(c.read, (Read{"1:A6 00 00 00", "2:1F 08 00 00"})) << i << ' ' << j;
    }
  }
}

TEST(DynamixelStatus, ErrorsAndAlertsAreTold) {
  Context c;
  c.Push(MakeStatus(3, 0x80, FromHex("01")));
  c.Push(MakeStatus(4, 0x84, {}));
  c.Push(MakeStatus(5, 7, {}));
  c.Push(MakeStatus(6, 0x55, {}));  // a number that the manual does not have
  EXPECT_EQ(c.read,
            (Read{"3:01 alert", "4: alert value out of range", "5: no access", "6: failed"}));
}

TEST(DynamixelStatus, StuffingIsTakenOut) {
  Context c;
  for (const char* data : {"FF FF FD", "FF FF FD FD", "FF FF FF FD 00", "FF FF FD FF FF FD 00",
                           "FD FF FF", "FF FF FD 00 01 07 00 55"}) {
    c.Push(MakeStatus(9, 0, FromHex(data)));
    ASSERT_FALSE(c.read.empty());
    EXPECT_EQ(c.read.back(), "9:" + Hex(FromHex(data)));
  }
}

TEST(DynamixelStatus, ATruncatedReplyCostsNoOtherReply) {
  const Bytes whole = FromHex(kPosition1);
  for (std::size_t from = 0; from < whole.size(); ++from) {
    for (std::size_t to = from + 1; to <= whole.size(); ++to) {  // these bytes are lost
      Context c;
      c.Push(FromHex(kPong));
      c.Push(std::span(whole).first(from));
      c.Push(std::span(whole).subspan(to));
      c.Push(FromHex(kPosition2));
      ASSERT_EQ(c.read, (Read{"1:06 04 26", "2:1F 08 00 00"})) << from << ".." << to;
    }
  }
}

TEST(DynamixelStatus, AWrongByteAnywhereIsFoundAndCostsNoOtherReply) {
  const Bytes whole = MakeStatus(1, 0, FromHex("A6 FF FF FD 00 12"));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int wrong = 0; wrong < 256; ++wrong) {
      Bytes damaged = whole;
      if (damaged[at] == static_cast<std::byte>(wrong)) continue;
      damaged[at] = static_cast<std::byte>(wrong);
      Context c;
      c.Push(damaged);
      ASSERT_TRUE(c.read.empty()) << at << ' ' << wrong;
      c.Push(FromHex(kPosition2));
      ASSERT_EQ(c.read, Read{"2:1F 08 00 00"}) << at << ' ' << wrong;
    }
  }
}

TEST(DynamixelStatus, AfterAnyNoiseTheFirstSoundReplyIsDelivered) {
  std::mt19937 random(5);
  for (int round = 0; round < 50'000; ++round) {
    Bytes noise(random() % 60);
    constexpr std::array kLikely = {0xFF, 0xFD, 0x00, 0x01, 0x55, 0x08};
    for (std::byte& b : noise) {
      b = static_cast<std::byte>(random() % 3 == 0 ? random() : kLikely[random() % 6]);
    }
    Context c;
    c.Push(noise);
    ASSERT_TRUE(c.read.empty()) << round;
    c.Push(FromHex(kPosition2));
    ASSERT_EQ(c.read, Read{"2:1F 08 00 00"}) << Hex(noise);
  }
}

TEST(DynamixelStatus, AnEchoOfInstructionsIsCountedAndNotTakenForReplies) {
  Context c;
  c.Push(FromHex("FF FF FD 00 01 03 00 01 19 4E"));
  c.Push(FromHex(kPong));
  EXPECT_EQ(c.read, Read{"1:06 04 26"});
  EXPECT_EQ(c.reader.stats().instructions, 1U);
}

TEST(DynamixelStatus, TheLongestReplyIsReadAndALongerOneSkipped) {
  Context c;
  c.Push(MakeStatus(1, 0, Bytes(kMaxStatusParameters, std::byte{7})));
  ASSERT_EQ(c.read.size(), 1U);
  c.Push(MakeStatus(1, 0, Bytes(kMaxStatusParameters + 1, std::byte{7})));
  EXPECT_EQ(c.read.size(), 1U);
  EXPECT_EQ(c.reader.stats().damaged, 1U);
  c.Push(FromHex(kDone));
  EXPECT_EQ(c.read.size(), 2U);
}

TEST(DynamixelStatus, ResetForgetsAHalfReply) {
  Context c;
  const Bytes pong = FromHex(kPong);
  c.Push(std::span(pong).first(9));
  c.reader.Reset();
  c.Push(std::span(pong).subspan(9));
  EXPECT_TRUE(c.read.empty());
  c.Push(FromHex(kPong));
  EXPECT_EQ(c.read.size(), 1U);
}

}  // namespace
}  // namespace facewire::wire::dynamixel
