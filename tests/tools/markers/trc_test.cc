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

std::string Trc(const std::string& unit, const std::string& data) {
  return "PathFileType\t4\t(X/Y/Z)\ttake.trc\n"
         "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOri"
         "gNumFrames\n"
         "120.00\t120.00\t2\t2\t" +
         unit +
         "\t120.00\t1\t2\n"
         "Frame#\tTime\tjaw\t\t\tbrow\t\t\n"
         "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
         "\n" +
         data;
}

std::string ErrorOf(const std::string& contents) {
  try {
    (void)ReadTrc(contents, "m.trc");
  } catch (const app::BadInput& error) {
    return error.what();
  }
  return "no error";
}

TEST(MarkerTrc, ReadsNamesRateAndMillimetresAsCentimetres) {
  const Take take =
      ReadTrc(Trc("mm", "1\t0.000\t10\t20\t30\t1\t2\t3\n2\t0.008\t11\t21\t31\t1\t2\t3\n"), "m.trc");
  EXPECT_THAT(take.names, ElementsAre("jaw", "brow"));
  EXPECT_EQ(take.rate_hz, 120);
  ASSERT_EQ(take.frames.size(), 2U);
  EXPECT_NEAR(take.frames[1][0].x, 1.1F, 1e-6F);
  EXPECT_NEAR(take.frames[1][1].z, 0.3F, 1e-6F);
}

TEST(MarkerTrc, TakesEmptyAndMissingFieldsAsGaps) {
  const Take take = ReadTrc(Trc("cm", "1\t0.000\t\t\t\t1\t2\t3\n2\t0.008\t1\t2\t3\n"), "m.trc");
  EXPECT_TRUE(std::isnan(take.frames[0][0].x));
  EXPECT_EQ(take.frames[0][1], (Point3{1, 2, 3}));
  EXPECT_TRUE(std::isnan(take.frames[1][1].x));
}

TEST(MarkerTrc, SaysWhatIsWrong) {
  EXPECT_THAT(ErrorOf("a_x,a_y,a_z\n"), HasSubstr("not a TRC file"));
  EXPECT_THAT(ErrorOf(Trc("furlong", "")), HasSubstr("\"furlong\"; mm, cm, m or in"));
  EXPECT_THAT(ErrorOf(Trc("mm", "1\t0\tx\t2\t3\t1\t2\t3\n")),
              HasSubstr("m.trc:7: \"x\" is not a number"));
  EXPECT_THAT(ErrorOf(Trc("mm", "1\t0\t1\t2\t3\t1\t2\t3\t4\t5\t6\n")),
              HasSubstr("11 fields for 2 markers"));
}

}  // namespace
}  // namespace facewire::tools::markers
