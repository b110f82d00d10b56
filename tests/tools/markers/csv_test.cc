#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "app/error.h"
#include "tools/markers/take.h"

namespace facewire::tools::markers {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string ErrorOf(const std::string& contents) {
  try {
    (void)ReadCsv(contents, "m.csv");
  } catch (const app::BadInput& error) {
    return error.what();
  }
  return "no error";
}

TEST(MarkerCsv, ReadsThreeColumnsAMarkerAndSkipsOthers) {
  const Take take = ReadCsv(
      "frame,chin_x,chin_y,chin_z,note,brow_x,brow_y,brow_z\n0,1,2,3,hi,-1.5,+2,3e1\n", "m.csv");
  EXPECT_THAT(take.names, ElementsAre("chin", "brow"));
  ASSERT_EQ(take.frames.size(), 1U);
  EXPECT_EQ(take.frames[0][0], (Point3{1, 2, 3}));
  EXPECT_EQ(take.frames[0][1], (Point3{-1.5F, 2, 30}));
}

TEST(MarkerCsv, TakesAnEmptyFieldAsAGapOfTheWholeMarker) {
  const Take take = ReadCsv("a_x,a_y,a_z\n1,,3\n", "m.csv");
  EXPECT_TRUE(std::isnan(take.frames[0][0].x));
  EXPECT_TRUE(std::isnan(take.frames[0][0].z));
}

TEST(MarkerCsv, ReadsWindowsLineEndsAByteOrderMarkAndQuotes) {
  const Take take = ReadCsv("\xEF\xBB\xBF\"a_x\",\"a_y\",\"a_z\"\r\n1,2,3\r\n\r\n", "m.csv");
  EXPECT_THAT(take.names, ElementsAre("a"));
  EXPECT_EQ(take.frames.size(), 1U);
}

TEST(MarkerCsv, DerivesTheRateFromATimeColumn) {
  const Take take = ReadCsv("time,a_x,a_y,a_z\n0,1,2,3\n0.01,1,2,3\n0.02,1,2,3\n", "m.csv");
  EXPECT_NEAR(take.rate_hz, 100, 1e-9);
}

TEST(MarkerCsv, SaysWhereALineIsWrong) {
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z\n1,2,3\n1,2\n"),
              HasSubstr("m.csv:3: 2 fields; the header has 3"));
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z\n1,two,3\n"), HasSubstr("m.csv:2: \"two\" is not a number"));
  EXPECT_THAT(ErrorOf("a_x,a_z,a_y\n1,2,3\n"),
              HasSubstr("m.csv:1: a_x is not followed by a_y and a_z"));
  EXPECT_THAT(ErrorOf("jawOpen,eyeBlink\n1,2\n"), HasSubstr("no columns NAME_x,NAME_y,NAME_z"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("empty"));
}

}  // namespace
}  // namespace facewire::tools::markers
