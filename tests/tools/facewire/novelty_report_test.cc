#include "tools/facewire/novelty_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace facewire::tools {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::array<std::string_view, 2> kRegions = {"eyes", "mouth"};

TEST(NoveltyReport, SaysNothingOfFamiliarFrames) {
  NoveltyReport report;
  report.Add(0, 0, std::array{0.0F, 2.4F});
  EXPECT_THAT(report.Lines(kRegions), IsEmpty());
}

TEST(NoveltyReport, NamesTheFrameThatIsMostUnlikeTheTraining) {
  NoveltyReport report;
  report.Add(511, 64'199'000, std::array{0.0F, 3.0F});
  report.Add(512, 64'216'000, std::array{0.0F, 7.5F});
  report.Add(513, 64'233'000, std::array{0.0F, 4.0F});
  EXPECT_THAT(report.Lines(kRegions),
              ElementsAre("mouth: 3 frames unlike any trained pose, most so frame 512 (1:04.2); "
                          "record a pose like it and train again with it"));
}

TEST(NoveltyReport, KeepsRegionsApart) {
  NoveltyReport report;
  report.Add(1, 0, std::array{9.0F, 0.0F});
  report.Add(2, 0, std::array{0.0F, 9.0F});
  const auto lines = report.Lines(kRegions);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines[0], testing::StartsWith("eyes: 1 frame unlike any trained pose, most so "
                                            "frame 1 (0:00.0)"));
}

}  // namespace
}  // namespace facewire::tools
