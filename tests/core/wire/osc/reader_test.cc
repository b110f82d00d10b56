#include "core/wire/osc/reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string_view>
#include <vector>

#include "core/wire/osc/osc.h"
#include "tests/core/wire/hex.h"

namespace facewire::wire::osc {
namespace {

using namespace std::string_view_literals;  // NOLINT(google-build-using-namespace): a literal

Errc ErrorOf(std::span<const std::byte> packet) {
  const auto reader = Reader::Of(packet);
  return reader ? Errc{} : reader.error();
}

TEST(OscReader, ReadsAMessageThatStandsAlone) {
  const auto packet = FromHex("2F 61 00 00 2C 66 00 00 3F 00 00 00");
  auto reader = Reader::Of(packet);
  ASSERT_TRUE(reader);
  const auto message = reader->Next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->address, "/a");
  EXPECT_EQ(message->types, "f");
  EXPECT_EQ(message->Number(), 0.5F);
  EXPECT_FALSE(reader->Next());
}

TEST(OscReader, ReadsEachMessageOfABundle) {
  std::array<std::byte, 256> buffer{};
  Writer writer(buffer);
  ASSERT_TRUE(writer.Bundle());
  ASSERT_TRUE(writer.Message("/a", std::int32_t{-3}, "text"sv));
  ASSERT_TRUE(writer.Message("/b"));
  auto reader = Reader::Of(writer.bytes());
  ASSERT_TRUE(reader);
  const auto first = reader->Next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->types, "is");
  EXPECT_EQ(first->Number(), -3.0F);
  const auto second = reader->Next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->address, "/b");
  EXPECT_FALSE(second->Number());
  EXPECT_FALSE(reader->Next());
}

TEST(OscReader, AnEmptyBundleHasNoMessages) {
  const auto packet = FromHex("23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00 01");
  auto reader = Reader::Of(packet);
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->Next());
}

TEST(OscReader, PassesOverEveryTypeOfOsc) {
  // blob of 3, double, true, nil, i32
  const auto packet = FromHex(
      "2F 61 00 00 2C 62 64 54 4E 69 00 00 00 00 00 03 01 02 03 00 "
      "00 00 00 00 00 00 00 00 00 00 00 07");
  EXPECT_EQ(ErrorOf(packet), Errc{});
}

TEST(OscReader, APacketThatDoesNotComeOutEvenIsRefusedWhole) {
  for (const char* hex :
       {"", "2F", "2F 61 00 00", "2F 61 62 63 2C 00 00 00",  // no NUL after the address
        "2F 61 00 01 2C 00 00 00",                           // not all of them NUL
        "61 00 00 00 2C 00 00 00",                           // no '/'
        "2F 61 00 00 69 00 00 00 00 00 00 01",               // no ','
        "2F 61 00 00 2C 69 00 00 00 00 00",                  // an argument too short
        "2F 61 00 00 2C 69 00 00",                           // none
        "2F 61 00 00 2C 00 00 00 00",                        // a byte too many
        "2F 61 00 00 2C 62 00 00 7F FF FF FF",               // a blob without an end
        "23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00",      // half a time tag
        "23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00 01 00 00 00 09 2F 61 00 00 2C 00 00 00",
        "23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00 01 00 00 00 08 2F 61 00 00 2C 00 00 00 00"}) {
    EXPECT_EQ(ErrorOf(FromHex(hex)), Errc::kCorrupt) << hex;
  }
  EXPECT_EQ(ErrorOf(FromHex("2F 61 00 00 2C 5B 5D 00")), Errc::kUnsupported) << "an array";
  EXPECT_EQ(ErrorOf(FromHex("23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00 01 00 00 00 10 "
                            "23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00 01")),
            Errc::kUnsupported)
      << "a bundle in a bundle";
}

// Whatever arrives: no read beyond the packet (under the sanitizer), and what is accepted adds up.
TEST(OscReader, AnyChangeOfAPacketIsReadWithinItsBounds) {
  std::array<std::byte, 256> buffer{};
  Writer writer(buffer);
  ASSERT_TRUE(writer.Bundle());
  ASSERT_TRUE(writer.Message("/facewire/blend", 0.5F));
  ASSERT_TRUE(writer.Message("/a", "text"sv, std::int32_t{1}));
  std::mt19937 dice(2);
  for (int round = 0; round < 100'000; ++round) {
    // Of its exact size, so that a read behind its end is seen.
    std::vector<std::byte> packet(writer.bytes().begin(), writer.bytes().end());
    packet.resize(dice() % (packet.size() + 8));
    for (unsigned changes = dice() % 4; changes > 0 && !packet.empty(); --changes) {
      packet[dice() % packet.size()] = static_cast<std::byte>(dice() % 256);
    }
    auto reader = Reader::Of(packet);
    if (!reader) continue;
    std::size_t bytes = 0;
    while (const auto message = reader->Next()) {
      EXPECT_TRUE(message->address.starts_with('/'));
      bytes += message->address.size() + message->types.size() + message->arguments.size();
      (void)message->Number();
    }
    EXPECT_LE(bytes, packet.size());
  }
}

}  // namespace
}  // namespace facewire::wire::osc
