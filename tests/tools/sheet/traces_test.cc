#include "tools/sheet/traces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace facewire::tools {
namespace {

TraceLane Lane() {
  TraceLane lane;
  lane.title = "jaw";
  lane.subtitle = {"bus \"head\": maestro, channel 0"};
  lane.remarks = {"command 60 ms behind"};
  lane.unit = "us";
  lane.low = 1000;
  lane.high = 2000;
  for (int i = 0; i <= 100; ++i) {
    const double t_s = i / 10.0;
    lane.parameter.push_back({t_s, 1500 + 300 * std::sin(t_s)});
    lane.command.push_back({t_s, 1500 + 300 * std::sin(t_s - 0.1)});
    lane.position.push_back({t_s, 1500 + 300 * std::sin(t_s - 0.2)});
  }
  lane.close_up = {4, 6};
  return lane;
}

cv::Mat Draw(const std::vector<TraceLane>& lanes) { return DrawTraces("t", {}, lanes, {0, 10}); }

int Difference(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  return cv::countNonZero(difference.reshape(1));
}

TEST(Traces, ArePicturesAsWideAsAllAndGrowWithTheirLanes) {
  const cv::Mat none = Draw({});
  const cv::Mat two = Draw({Lane(), Lane()});
  EXPECT_EQ(two.cols, kSheetWidthPx);
  EXPECT_GT(two.rows, none.rows + 300);
}

TEST(Traces, ShowEachCurve) {
  const cv::Mat all = Draw({Lane()});
  for (Curve TraceLane::*curve :
       {&TraceLane::parameter, &TraceLane::command, &TraceLane::position}) {
    TraceLane without = Lane();
    (without.*curve).clear();
    EXPECT_GT(Difference(all, Draw({without})), 1000);
  }
}

TEST(Traces, InterruptACurveWhereItHasNoValue) {
  TraceLane limp = Lane();
  for (std::size_t i = 20; i < 80; ++i) limp.command[i].value = NAN;
  EXPECT_GT(Difference(Draw({Lane()}), Draw({limp})), 500);
}

TEST(Traces, HoldACommandThroughACloseUpWithoutANewOne) {
  TraceLane lane = Lane();
  lane.command = {{0, 1400}, {9, 1500}};
  TraceLane without = lane;
  without.command = {{0, NAN}, {9, 1500}};
  EXPECT_GT(Difference(Draw({lane}), Draw({without})), 500);
}

TEST(Traces, CopeWithLanesWithoutAnything) {
  TraceLane lane;
  lane.high = 1;
  lane.close_up = {1, 3};
  EXPECT_EQ(Draw({lane}).cols, kSheetWidthPx);
}

}  // namespace
}  // namespace facewire::tools
