#include "core/base/arena.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace facewire {
namespace {

TEST(Arena, AnExactFitUsesTheLastByte) {
  alignas(16) std::array<std::byte, 64> block;
  Arena arena(block);
  EXPECT_EQ(arena.Allocate(64, 16), block.data());
  EXPECT_EQ(arena.used(), 64U);
  EXPECT_EQ(arena.Allocate(1, 1), nullptr);
}

TEST(Arena, OneByteTooManyLeavesTheArenaAsItWas) {
  alignas(16) std::array<std::byte, 64> block;
  Arena arena(block);
  EXPECT_EQ(arena.Allocate(65, 1), nullptr);
  EXPECT_EQ(arena.used(), 0U);
  EXPECT_NE(arena.Allocate(64, 1), nullptr);
}

TEST(Arena, AlignsAndCountsThePadding) {
  alignas(64) std::array<std::byte, 256> block;
  Arena arena(block);
  ASSERT_NE(arena.Allocate(1, 1), nullptr);
  void* at = arena.Allocate(8, 64);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(at) % 64, 0U);
  EXPECT_EQ(arena.used(), 72U);
}

TEST(Arena, ArraysAreValueInitialisedAndHugeCountsDoNotOverflow) {
  alignas(16) std::array<std::byte, 64> block;
  block.fill(std::byte{0xFF});
  Arena arena(block);
  for (int value : arena.MakeArray<int>(4)) EXPECT_EQ(value, 0);
  EXPECT_TRUE(arena.MakeArray<double>(SIZE_MAX / 4).empty());
}

}  // namespace
}  // namespace facewire
