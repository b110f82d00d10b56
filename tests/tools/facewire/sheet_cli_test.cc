#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;

constexpr char kRig[] = "name = \"mini\"\n[[parameter]]\nname = \"jawOpen\"\n";

TEST(FacewireSheet, DrawsAPictureOfARecordingAndSaysWhatItShows) {
  const Scratch scratch;
  std::string recording = "frame,t_us,age_us,state,jawOpen\n";
  for (int i = 0; i < 30; ++i) {
    recording += std::to_string(i) + "," + std::to_string(i * 41667) + ",5000,tracking," +
                 (i == 28 ? "0.9" : "0") + "\n";
  }
  const Outcome outcome =
      RunFacewire({"sheet", scratch.Write("wire.csv", recording), "--video", ShortClip(scratch, 30),
                   "--rig", scratch.Write("rig.toml", kRig), "--figure", "CRC errors=0", "--out",
                   scratch.Path("sheet.png")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("CRC errors         0"));
  EXPECT_THAT(outcome.out, HasSubstr("frames a second    24.0"));
  const cv::Mat picture = cv::imread(scratch.Path("sheet.png"));
  EXPECT_EQ(picture.cols, 1600);
  EXPECT_GT(picture.rows, 800);  // a calm moment, and one with the mouth open
}

TEST(FacewireSheet, NamesAChannelThatTheRecordingLacks) {
  const Scratch scratch;
  const Outcome outcome = RunFacewire(
      {"sheet", scratch.Write("wire.csv", "frame,t_us,age_us,state\n0,0,0,tracking\n"), "--video",
       "x.mp4", "--rig", scratch.Write("rig.toml", kRig), "--out", scratch.Path("sheet.png")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the rig's channel jawOpen is not in it"));
}

}  // namespace
}  // namespace facewire::tools
