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

TEST(MarkerCsv, KeepsTheNumbersAndTimesOfFrames) {
  const Take take = ReadCsv("frame,t_us,a_x,a_y,a_z\n7,1000000,1,2,3\n9,1020000,1,2,3\n", "m.csv");
  EXPECT_EQ(take.Number(1), 9U);
  EXPECT_EQ(take.TimeUs(0), 0);
  EXPECT_EQ(take.TimeUs(1), 20000);
}

TEST(MarkerCsv, CountsFramesOfAnUnknownRateAsSixtyASecond) {
  const Take take = ReadCsv("a_x,a_y,a_z\n1,2,3\n1,2,3\n1,2,3\n1,2,3\n", "m.csv");
  EXPECT_EQ(take.Number(3), 3U);
  EXPECT_EQ(take.TimeUs(3), 50000);
}

TEST(MarkerCsv, OfSamplesHoldsNothingElseAndNoGaps) {
  const CsvRules samples{.only_markers = true, .gaps = false};
  const auto error = [&](const std::string& contents) {
    try {
      (void)ReadCsv(contents, "m.csv", samples);
    } catch (const app::BadInput& bad) {
      return std::string(bad.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error("frame,time_s,a_x,a_y,a_z\n0,0,1,2,3\n"), "no error");
  EXPECT_THAT(error("jaw,a_x,a_y,a_z\n1,2,3,4\n"), HasSubstr("column jaw does not start a marker"));
  EXPECT_THAT(error("a_x,a_y,a_z,b_x\n1,2,3,4\n"), HasSubstr("b_x is not followed by b_y"));
  EXPECT_THAT(error("a_x,a_y,a_z,b_x,b_y,b_z\n1,2,3,4,5,6\n\n1,2,3,4,,6\n"),
              HasSubstr("m.csv:4: the marker b was not seen here"));
}

TEST(MarkerCsv, SaysWhereALineIsWrong) {
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z\n1,2,3\n1,2\n"),
              HasSubstr("m.csv:3: 2 fields; the header has 3"));
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z\n1,two,3\n"),
              HasSubstr("m.csv:2: column a_y: \"two\" is not a number"));
  EXPECT_THAT(ErrorOf("a_x,a_z,a_y\n1,2,3\n"),
              HasSubstr("m.csv:1: a_x is not followed by a_y and a_z"));
  EXPECT_THAT(ErrorOf("jawOpen,eyeBlink\n1,2\n"), HasSubstr("no columns NAME_x,NAME_y,NAME_z"));
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z\n1,inf,3\n"), HasSubstr("\"inf\" is not a number"));
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z\n1,1e99,3\n"), HasSubstr("not a number that is small enough"));
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z,a_x,a_y,a_z\n1,2,3,1,2,3\n"), HasSubstr("a appears twice"));
  EXPECT_THAT(ErrorOf("frame,a_x,a_y,a_z\n1.5,1,2,3\n"),
              HasSubstr("m.csv:2: frame is not a whole number"));
  EXPECT_THAT(ErrorOf("t_us,a_x,a_y,a_z\n0,1,2,3\n,1,2,3\n"), HasSubstr("m.csv:3: column t_us"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("m.csv:1: no columns"));
}

}  // namespace
}  // namespace facewire::tools::markers
