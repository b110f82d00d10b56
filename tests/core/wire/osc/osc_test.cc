#include "core/wire/osc/osc.h"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "tests/core/wire/hex.h"

namespace facewire::wire::osc {
namespace {

using namespace std::string_view_literals;  // NOLINT(google-build-using-namespace): a literal

struct Context {
  std::array<std::byte, 256> buffer{};
  Writer packet{buffer};
};

TEST(Osc, AMessageIsItsAddressItsTypesAndItsArguments) {
  Context c;
  ASSERT_TRUE(c.packet.Message("/a", std::int32_t{1}, 0.5F, "abc"sv));
  EXPECT_EQ(Hex(c.packet.bytes()),
            "2F 61 00 00 2C 69 66 73 00 00 00 00 00 00 00 01 3F 00 00 00 61 62 63 00");
}

TEST(Osc, StringsEndWithOneToFourNuls) {
  for (const auto& [text, hex] :
       {std::pair{"/"sv, "2F 00 00 00"}, std::pair{"/ab"sv, "2F 61 62 00"},
        std::pair{"/abc"sv, "2F 61 62 63 00 00 00 00"}}) {
    Context c;
    ASSERT_TRUE(c.packet.Message(text));
    EXPECT_EQ(Hex(c.packet.bytes()), std::string(hex) + " 2C 00 00 00");
  }
}

TEST(Osc, ABundleHasTheTimeTagOfAtOnceAndTheSizeBeforeEachMessage) {
  Context c;
  ASSERT_TRUE(c.packet.Bundle());
  ASSERT_TRUE(c.packet.Message("/a", std::int32_t{-1}));
  ASSERT_TRUE(c.packet.Message("/b"));
  EXPECT_EQ(Hex(c.packet.bytes()),
            "23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00 01 "
            "00 00 00 0C 2F 61 00 00 2C 69 00 00 FF FF FF FF "
            "00 00 00 08 2F 62 00 00 2C 00 00 00");
}

TEST(Osc, AMessageThatDoesNotFitLeavesWhatWasThere) {
  std::array<std::byte, 16 + 16 + 15> buffer{};
  Writer packet(buffer);
  ASSERT_TRUE(packet.Bundle());
  ASSERT_TRUE(packet.Message("/a", std::int32_t{1}));
  EXPECT_EQ(packet.Message("/b", std::int32_t{2}).error(), Errc::kFull);
  EXPECT_EQ(packet.bytes().size(), 32U);
  EXPECT_TRUE(packet.Message("/c"));
  EXPECT_EQ(packet.bytes().size(), 44U);
}

TEST(Osc, FitsExactlyAndNotInOneByteLess) {
  std::array<std::byte, 12> buffer{};
  Writer exact(buffer);
  EXPECT_TRUE(exact.Message("/a", 1.0F));
  Writer less{std::span(buffer).first(11)};
  EXPECT_EQ(less.Message("/a", 1.0F).error(), Errc::kFull);
  EXPECT_TRUE(less.bytes().empty());
  Writer no_bundle(buffer);
  EXPECT_EQ(no_bundle.Bundle().error(), Errc::kFull);
  EXPECT_TRUE(no_bundle.bytes().empty());
}

TEST(Osc, RefusesWhatNoReceiverCouldRead) {
  Context c;
  EXPECT_EQ(c.packet.Message("a").error(), Errc::kInvalidArgument);
  EXPECT_EQ(c.packet.Message("/a", "b\0c"sv).error(), Errc::kInvalidArgument);
  EXPECT_TRUE(c.packet.bytes().empty());
  ASSERT_TRUE(c.packet.Message("/a"));
  EXPECT_EQ(c.packet.Message("/b").error(), Errc::kInvalidArgument);  // a second one needs a bundle
  EXPECT_EQ(c.packet.Bundle().error(), Errc::kInvalidArgument);
  EXPECT_EQ(c.packet.bytes().size(), 8U);
}

}  // namespace
}  // namespace facewire::wire::osc
