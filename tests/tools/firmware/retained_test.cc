#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>

#include "tests/tools/firmware/firmware.h"

namespace facewire::firmware {
namespace {

std::array<std::uint16_t, FW_SERVOS> All(std::uint16_t width) {
  std::array<std::uint16_t, FW_SERVOS> positions;
  positions.fill(width);
  return positions;
}

TEST(Retained, WhatWasWrittenLastIsRemembered) {
  FwRetained retained = {};
  std::uint8_t turn = 200;
  for (std::uint16_t width = 4000; width < 4300; ++width, ++turn) {  // turn wraps
    FwRetain(&retained, turn, All(width).data());
    const std::uint16_t* remembered = FwRemember(&retained);
    ASSERT_NE(remembered, nullptr);
    EXPECT_EQ(remembered[FW_SERVOS - 1], width);
  }
}

TEST(Retained, AResetWhileItIsWrittenLeavesTheOneBefore) {
  FwRetained retained = {};
  FwRetain(&retained, 1, All(4000).data());
  FwRetain(&retained, 2, All(5000).data());
  retained.copies[0].position[3] = 7000;
  ASSERT_NE(FwRemember(&retained), nullptr);
  EXPECT_EQ(FwRemember(&retained)[3], 4000);
}

TEST(Retained, MemoryAfterAPowerOnIsNotMistaken) {
  std::mt19937 random(1);
  FwRetained retained = {};
  EXPECT_EQ(FwRemember(&retained), nullptr);
  std::memset(&retained, 0xFF, sizeof retained);
  EXPECT_EQ(FwRemember(&retained), nullptr);
  for (int round = 0; round < 1000; ++round) {
    for (FwRetainedCopy& copy : retained.copies) {
      for (std::uint16_t& p : copy.position) p = static_cast<std::uint16_t>(random());
      copy.crc = static_cast<std::uint32_t>(random());
    }
    EXPECT_EQ(FwRemember(&retained), nullptr);
  }
}

}  // namespace
}  // namespace facewire::firmware
