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

// Trains a jaw of `rows` rows and returns the profile's path.
std::string TrainedProfile(const Scratch& scratch, int rows) {
  std::string markers = "chin_x,chin_y,chin_z,lip_x,lip_y,lip_z\n";
  std::string targets = "jawOpen\n";
  for (int row = 0; row < rows; ++row) {
    const std::string part = std::to_string(static_cast<double>(row) / rows);
    markers += "0,-" + std::to_string(8 + row) + ",4,0,-4," + part + "\n";
    targets += part + "\n";
  }
  const std::string profile = scratch.Path("p.profile");
  const Outcome trained = RunFacewire({"train", "--markers", scratch.Write("m.csv", markers),
                                       "--targets", scratch.Write("t.csv", targets), "--epsilon",
                                       "0.5", "--smoothing", "0.01", "--out", profile});
  EXPECT_EQ(trained.code, 0) << trained.err;
  return profile;
}

TEST(FacewireSheet, DrawsTheRowsOfATraining) {
  const Scratch scratch;
  const std::string profile = TrainedProfile(scratch, 80);
  const auto draw = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"sheet", "--training", profile, "--out", scratch.Path("sheet.png")});
    const Outcome outcome = RunFacewire(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return cv::imread(scratch.Path("sheet.png")).rows;
  };
  const int all_that_fit = draw({});
  EXPECT_LT(all_that_fit, 6000);
  EXPECT_LT(draw({"--rows", "80:80"}), draw({"--rows", "5:9"}));
}

TEST(FacewireSheet, SaysWhichRowsATrainingHas) {
  const Scratch scratch;
  const std::string profile = TrainedProfile(scratch, 80);
  for (const char* rows : {"0:3", "3:2", "1:81", "a:b", ":", "-1:2", "1:2:3", ""}) {
    const Outcome outcome = RunFacewire(
        {"sheet", "--training", profile, "--rows", rows, "--out", scratch.Path("sheet.png")});
    EXPECT_EQ(outcome.code, 2) << rows;
    EXPECT_THAT(outcome.err, HasSubstr("--rows: ")) << rows;
  }
  const Outcome many = RunFacewire(
      {"sheet", "--training", profile, "--rows", "1:61", "--out", scratch.Path("sheet.png")});
  EXPECT_THAT(many.err, HasSubstr("61 rows; a sheet shows at most 60"));
  EXPECT_FALSE(std::filesystem::exists(scratch.Path("sheet.png")));
}

TEST(FacewireSheet, NeedsARecordingOrATrainingAndNotBoth) {
  const Scratch scratch;
  const std::string out = scratch.Path("sheet.png");
  const auto error = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"sheet", "--out", out});
    const Outcome outcome = RunFacewire(more);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(error({}), HasSubstr("a RECORDING with --video and --rig is needed"));
  EXPECT_THAT(error({"wire.csv"}), HasSubstr("a RECORDING with --video and --rig is needed"));
  EXPECT_THAT(error({"wire.csv", "--training", "p.profile"}), HasSubstr("excludes --training"));
  EXPECT_THAT(error({"--rig", "rig.toml", "--training", "p.profile"}),
              HasSubstr("excludes --training"));
  EXPECT_THAT(error({"--rows", "1:2"}), HasSubstr("--rows requires --training"));
  EXPECT_THAT(error({"--training", "none.profile"}), HasSubstr("none.profile"));
  EXPECT_EQ(scratch.Files(), 0U);
}

}  // namespace
}  // namespace facewire::tools
