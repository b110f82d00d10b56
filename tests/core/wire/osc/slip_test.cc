#include "core/wire/osc/slip.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "tests/core/wire/hex.h"

namespace facewire::wire::osc {
namespace {

struct Context {
  // What comes of the bytes: packets as hex, errors by name.
  std::vector<std::string> Take(std::span<const std::byte> bytes) {
    std::vector<std::string> all;
    for (;;) {
      const auto packet = decoder.Next(bytes);
      if (!packet && packet.error() == Errc::kNotReady) return all;
      all.push_back(packet ? Hex(*packet) : Name(packet.error()));
    }
  }
  std::vector<std::string> Take(const char* hex) { return Take(FromHex(hex)); }

  std::array<std::byte, 4> memory{};
  SlipDecoder decoder{memory};
};

using Seen = std::vector<std::string>;

TEST(Slip, HasEndsOnBothSidesAndEscapesItsOwnBytes) {
  const auto packet = FromHex("00 C0 01 DB DC DD FF");
  std::array<std::byte, MaxSlipBytes(7)> out{};
  EXPECT_EQ(Hex(*Slip(packet, out)), "C0 00 DB DC 01 DB DD DC DD FF C0");
}

TEST(Slip, FitsExactlyAndNotInOneByteLess) {
  const auto packet = FromHex("C0 DB");
  std::array<std::byte, MaxSlipBytes(2)> out{};
  EXPECT_EQ(Slip(packet, out)->size(), out.size());
  EXPECT_EQ(Slip(packet, std::span(out).first(5)).error(), Errc::kFull);
  EXPECT_EQ(Slip({}, out).error(), Errc::kInvalidArgument);
}

TEST(SlipDecoder, GivesBackWhatWasEscaped) {
  Context c;
  EXPECT_EQ(c.Take("C0 DB DC 01 DB DD C0 C0 C0 02 C0 03 C0"), (Seen{"C0 01 DB", "02", "03"}));
}

TEST(SlipDecoder, TakesAPacketThatFitsExactlyAndDropsALongerOneAlone) {
  Context c;
  EXPECT_EQ(c.Take("01 02 03 04 C0 01 02 03 04 05 06 C0 07 C0"),
            (Seen{"01 02 03 04", Name(Errc::kFull), "07"}));
}

TEST(SlipDecoder, DropsAnEscapeThatStandsForNothing) {
  Context c;
  EXPECT_EQ(c.Take("01 DB 02 C0 03 C0 04 DB C0 05 C0"),
            (Seen{Name(Errc::kCorrupt), "03", Name(Errc::kCorrupt), "05"}));
}

TEST(SlipDecoder, DoesNotMindHowTheStreamIsCut) {
  const auto stream = FromHex("C0 DB DC 01 C0 DB 01 C0 01 02 03 04 05 C0 DB DD C0");
  Context whole;
  const Seen expected = whole.Take(stream);
  EXPECT_EQ(expected.size(), 4U);
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    Context c;
    Seen seen = c.Take(std::span(stream).first(cut));
    const Seen rest = c.Take(std::span(stream).subspan(cut));
    seen.insert(seen.end(), rest.begin(), rest.end());
    EXPECT_EQ(seen, expected) << cut;
  }
}

TEST(SlipDecoder, AnyBytesThenAPacketGiveThatPacketLast) {
  std::mt19937 dice(1);
  for (int round = 0; round < 20'000; ++round) {
    std::vector<std::byte> noise(dice() % 12);
    for (std::byte& b : noise) {
      constexpr std::array kLikely = {0xC0, 0xDB, 0xDC, 0xDD};
      b = static_cast<std::byte>(dice() % 2 == 0 ? kLikely[dice() % 4] : dice() % 256);
    }
    Context c;
    (void)c.Take(noise);
    EXPECT_EQ(c.Take("C0 01 02 C0").back(), "01 02");
  }
}

}  // namespace
}  // namespace facewire::wire::osc
