#include "app/marker_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string MarkerError(const std::string& content) {
  const Scratch scratch;
  const auto path = scratch.Write("m.csv", content);
  return BadInputOf([&] { ReadMarkerTable(path); });
}

std::string NumberError(const std::string& content) {
  const Scratch scratch;
  const auto path = scratch.Write("t.csv", content);
  return BadInputOf([&] { ToNames(path, ReadNumberTable(path).columns); });
}

TEST(MarkerTable, ReadsMarkersAndLeavesRowNumbersAndTimesOut) {
  const Scratch scratch;
  const auto path = scratch.Write("m.csv", "frame,time_s,a_x,a_y,a_z,lip L_x\n");
  EXPECT_THAT(BadInputOf([&] { ReadMarkerTable(path); }), HasSubstr("no rows"));
  const auto good = scratch.Write("good.csv",
                                  "\xEF\xBB\xBF"
                                  "frame,time_s,a_x,a_y,a_z,\"b_1_x\",b_1_y,b_1_z\r\n"
                                  "0,0.00,1,2,3,4,5,6\r\n\r\n1,0.01,-1,.5,3e-1, 4 ,5,6\r\n");
  const MarkerTable table = ReadMarkerTable(good);
  ASSERT_EQ(table.markers.size(), 2U);
  EXPECT_EQ(table.markers[1].view(), "b_1");
  EXPECT_THAT(table.positions_cm, ElementsAre(1, 2, 3, 4, 5, 6, -1, 0.5F, 0.3F, 4, 5, 6));
  EXPECT_THAT(table.lines, ElementsAre(2U, 4U));
}

TEST(MarkerTable, SaysWhereTheInputIsWrong) {
  EXPECT_THAT(MarkerError("a_x,a_y,a_z\n1,2,3\n1,2\n"),
              HasSubstr("m.csv:3: 2 columns, but line 1 has 3"));
  EXPECT_THAT(MarkerError("a_x,a_y,a_z\n1,2,x3\n"),
              HasSubstr("m.csv:2: column 3: \"x3\" is not a finite number"));
  EXPECT_THAT(MarkerError("a_x,a_y,a_z\n1,,3\n"), HasSubstr("column 2: \"\""));
  EXPECT_THAT(MarkerError("a_x,a_y,a_z\n1,nan,3\n"), HasSubstr("\"nan\" is not a finite number"));
  EXPECT_THAT(MarkerError("a_x,a_y,a_z\n1,1e99,3\n"), HasSubstr("is not a finite number"));
  EXPECT_THAT(MarkerError(""), HasSubstr("m.csv:1: no columns"));
  EXPECT_THAT(MarkerError("frame,time_s\n0,0\n"), HasSubstr("no columns besides"));
  EXPECT_THAT(MarkerError("a_x,a_y,a_z\n"), HasSubstr("no rows"));
}

TEST(MarkerTable, SaysWhichColumnIsNoMarker) {
  EXPECT_THAT(MarkerError("a_x,a_y,b_z\n1,2,3\n"), HasSubstr("column \"a_x\""));
  EXPECT_THAT(MarkerError("a_x,a_y,a_z,b_x\n1,2,3,4\n"), HasSubstr("column \"b_x\""));
  EXPECT_THAT(MarkerError("jaw,a_x,a_y,a_z\n1,2,3,4\n"), HasSubstr("column \"jaw\""));
  EXPECT_THAT(MarkerError("a_x,a_y,a_z,a_x,a_y,a_z\n1,2,3,1,2,3\n"), HasSubstr("appears twice"));
}

TEST(NumberTable, NamesHaveToBeNamesAndDifferent) {
  EXPECT_THAT(NumberError("open,open\n1,2\n"), HasSubstr("\"open\" appears twice"));
  EXPECT_THAT(NumberError("jaw open\n1\n"), HasSubstr("\"jaw open\" cannot be a name"));
  EXPECT_THAT(NumberError("a,,b\n1,2,3\n"), HasSubstr("\"\" cannot be a name"));
  EXPECT_THAT(NumberError(std::string(32, 'a') + "\n1\n"), HasSubstr("1 to 31"));
}

TEST(NumberTable, AMissingFileIsNamed) {
  EXPECT_THAT(BadInputOf([] { ReadNumberTable("no-such.csv"); }),
              HasSubstr("no-such.csv: there is no such file"));
}

}  // namespace
}  // namespace facewire::app
