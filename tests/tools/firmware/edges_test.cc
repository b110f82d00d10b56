#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "tests/tools/firmware/firmware.h"

namespace facewire::firmware {
namespace {

using Widths = std::array<std::uint16_t, FW_SERVOS>;

// Whatever the widths: in order, apart, each pulse as long as it shall be, all within the period.
void ExpectGoodPlan(const Widths& widths) {
  std::array<FwEdge, FW_MAX_EDGES> edges;
  FwPlanEdges(widths.data(), edges.data());
  std::map<int, int> rose;
  std::map<int, int> length;
  int last = 0;
  for (const FwEdge& edge : edges) {
    ASSERT_GE(edge.at, last + FW_EDGE_GAP);
    last = edge.at;
    if ((edge.what & kFwPeriodEnd) != 0) break;
    const int servo = edge.what & 0x0F;
    if ((edge.what & kFwRise) != 0) {
      ASSERT_TRUE(rose.emplace(servo, edge.at).second);
    } else {
      ASSERT_TRUE(rose.contains(servo));
      ASSERT_TRUE(length.emplace(servo, edge.at - rose[servo]).second);
    }
  }
  ASSERT_LE(last + FW_EDGE_GAP, FW_PERIOD);
  for (int servo = 0; servo < FW_SERVOS; ++servo) {
    const int width = widths[static_cast<std::size_t>(servo)];
    ASSERT_EQ(length.contains(servo) ? length[servo] : 0, width);
  }
}

TEST(Edges, WithoutPulsesThereIsOnlyThePeriodsEnd) {
  std::array<FwEdge, FW_MAX_EDGES> edges;
  FwPlanEdges(Widths{}.data(), edges.data());
  EXPECT_EQ(edges[0].what, kFwPeriodEnd);
}

TEST(Edges, EveryCommonWidthIsPlanned) {
  for (int half_us = 1000; half_us <= 5000; ++half_us) {
    Widths widths;
    widths.fill(static_cast<std::uint16_t>(half_us));
    ExpectGoodPlan(widths);
  }
}

TEST(Edges, AnyWidthsArePlanned) {
  std::mt19937 random(5);
  for (int round = 0; round < 200'000; ++round) {
    // Widths that differ little, by the distance of two starts or by anything: where edges meet.
    const auto spread = std::array{60U, 200U, 4001U}[random() % 3];
    const auto base = 1000 + random() % (4001 - std::min(spread, 4000U));
    Widths widths;
    for (std::uint16_t& width : widths) {
      width = static_cast<std::uint16_t>(std::min<std::size_t>(base + random() % spread, 5000));
      if (random() % 4 == 0) width = static_cast<std::uint16_t>(1000 + (width + 1900) % 4001);
      if (random() % 8 == 0) width = 0;
    }
    ExpectGoodPlan(widths);
    if (testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace facewire::firmware
