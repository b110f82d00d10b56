#include "core/wire/crc32.h"

#include <gtest/gtest.h>

#include <string_view>

namespace facewire::wire {
namespace {

std::span<const std::byte> BytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

std::uint32_t CrcOf(std::span<const std::byte> bytes) {
  Crc32 crc;
  crc.Add(bytes);
  return crc.value();
}

TEST(Crc32, HasTheCheckValueOfItsCatalogueEntry) {
  EXPECT_EQ(CrcOf(BytesOf("123456789")), 0xCBF43926U);
}

TEST(Crc32, OfNothingIsZero) { EXPECT_EQ(Crc32().value(), 0U); }

TEST(Crc32, IsTheSameHoweverTheInputIsSplit) {
  const auto all = BytesOf("The quick brown fox jumps over the lazy dog");
  for (std::size_t i = 0; i <= all.size(); ++i) {
    Crc32 crc;
    crc.Add(all.first(i));
    crc.Add(all.subspan(i));
    EXPECT_EQ(crc.value(), 0x414FA339U) << "split at " << i;
  }
}

}  // namespace
}  // namespace facewire::wire
