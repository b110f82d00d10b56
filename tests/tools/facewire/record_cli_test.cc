#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/generated_face.h"
#include "tests/tools/facewire/run.h"
#include "tools/facewire/landmark_file.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// A landmark file of a face that turns; every third picture shows none.
std::string TurningFace(const Scratch& scratch, int frames) {
  std::string lines;
  for (int i = 0; i < frames; ++i) {
    Sighting seen{static_cast<std::uint64_t>(i), i * 40'000, std::nullopt};
    if (i % 3 != 2) {
      test::View view;
      view.rotation = test::Rotation(0, static_cast<float>(i), 0);
      seen.face = test::Photograph(test::GeneratedFace(), view);
    }
    lines += LandmarkLine(seen);
  }
  return scratch.Write("face.jsonl", lines);
}

TEST(FacewireRecord, WritesLandmarksWithoutHeadMotionAndLeavesOutFramesWithoutAFace) {
  const Scratch scratch;
  const Outcome outcome = RunFacewire({"record", TurningFace(scratch, 9), "--unfiltered",
                                       "--markers", "lm1,lm13", "--out", scratch.Path("s.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("9 frames, 6 rows of 2 markers"));
  const std::string rows = scratch.Read("s.csv");
  EXPECT_THAT(rows, StartsWith("frame,t_us,lm1_x,lm1_y,lm1_z,lm13_x,lm13_y,lm13_z\n0,0,"));
  EXPECT_THAT(rows, HasSubstr("\n1,40000,"));
  EXPECT_THAT(rows, testing::Not(HasSubstr("\n2,80000,")));
  const test::FacePoints face = test::GeneratedFace();
  const std::size_t last = rows.find("\n7,280000,");
  ASSERT_NE(last, std::string::npos);
  EXPECT_NEAR(std::stod(rows.substr(last + 10)), static_cast<double>(face[1].x), 0.01);
}

TEST(FacewireRecord, RecordsAVideo) {
  const Scratch scratch;
  const Outcome outcome =
      RunFacewire({"record", ShortClip(scratch, 6), "--out", scratch.Path("s.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string rows = scratch.Read("s.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 7);
  EXPECT_EQ(std::ranges::count(rows.substr(0, rows.find('\n')), ','), 1 + 3 * 478);
}

TEST(FacewireRecord, TakesHeadMotionOutOfMarkersAndKeepsTheirGaps) {
  const Scratch scratch;
  const std::string take = scratch.Write(
      "m.csv",
      "time_s,a_x,a_y,a_z,b_x,b_y,b_z,c_x,c_y,c_z,chin_x,chin_y,chin_z\n"
      "10,0,1,0,2,0,0,-2,0,0,0,-5,1\n10.01,7,1,0,9,0,0,5,0,0,7,-6,1\n10.02,7,1,0,9,0,0,5,0,0,,,\n"
      "10.03,,,,9,0,0,5,0,0,7,-5,1\n");
  const Outcome outcome = RunFacewire(
      {"record", take, "--rigid", "a,b,c", "--markers", "b,chin", "--out", scratch.Path("s.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(scratch.Read("s.csv"),
            "frame,t_us,b_x,b_y,b_z,chin_x,chin_y,chin_z\n"
            "0,0,2,0,0,0,-5,1\n1,10000,2,0,0,0,-6,1\n2,20000,2,0,0,,,\n");
  EXPECT_THAT(outcome.err, HasSubstr("keep their places to 0.000 cm rms"));
}

TEST(FacewireRecord, StopsAfterTheSecondsAndWritesJsonLines) {
  const Scratch scratch;
  const std::string take =
      scratch.Write("m.csv", "time,a_x,a_y,a_z\n0,1,2,3\n0.5,,,\n1,1,2,4\n1.5,1,2,5\n");
  const Outcome outcome =
      RunFacewire({"record", take, "--seconds", "1.2", "--out", scratch.Path("s.jsonl")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(scratch.Read("s.jsonl"),
            "{\"frame\":0,\"t_us\":0,\"markers\":{\"a\":[1,2,3]}}\n"
            "{\"frame\":2,\"t_us\":1000000,\"markers\":{\"a\":[1,2,4]}}\n");
}

TEST(FacewireRecord, AnswersBadInputWithOneLineAndNoFile) {
  const Scratch scratch;
  const std::string out = scratch.Path("out.csv");
  const std::string markers = scratch.Write("m.csv", "chin_x,chin_y,chin_z\n1,2,3\n");
  const std::string blank = scratch.Write("blank.csv", "chin_x,chin_y,chin_z\n,,\n");
  const std::string faces = TurningFace(scratch, 2);
  struct Case {
    std::vector<std::string> arguments;
    std::string says;
  };
  const Case cases[] = {
      {{markers}, "--out is required"},
      {{markers, "--out", scratch.Path("out.mp4")}, "ends in .csv or .jsonl"},
      {{markers, "--out", out, "--markers", "chinn"}, "did you mean \"chin\"?"},
      {{markers, "--out", out, "--rigid", "nose"}, "--rigid: there is no marker nose"},
      {{markers, "--out", out, "--rigid", "chin"}, "three markers or more"},
      {{markers, "--out", out, "--unfiltered"}, "--unfiltered is for faces"},
      {{markers, "--out", out, "--seconds", "-1"}, "--seconds"},
      {{blank, "--out", out}, "nothing to record is seen in its 1 frames"},
      {{faces, "--out", out, "--rigid", "lm1"}, "--rigid is for markers"},
      {{faces, "--out", out, "--markers", "lm500"}, "there is no marker lm500"},
      {{scratch.Write("x.jsonl", "{}\n"), "--out", out}, "x.jsonl:1: not a line"},
      {{"/nowhere.csv", "--out", out}, "/nowhere.csv"},
  };
  const std::size_t files = scratch.Files();
  for (const Case& bad : cases) {
    std::vector<std::string> arguments = {"record"};
    arguments.insert(arguments.end(), bad.arguments.begin(), bad.arguments.end());
    const Outcome outcome = RunFacewire(arguments);
    EXPECT_EQ(outcome.code, 2) << bad.says << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(bad.says));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  }
  EXPECT_EQ(scratch.Files(), files);
}

// A landmark file goes wherever a video does, and gives the same.
TEST(FacewireRecord, LandmarkFilesStandInForTheirVideo) {
  const Scratch scratch;
  const std::string clip = ShortClip(scratch, 6);
  const std::string seen = scratch.Path("seen.jsonl");
  ASSERT_EQ(RunFacewire({"track", clip, "--out", seen}).code, 0);
  const auto rows = [&](const std::string& input) {
    const Outcome outcome =
        RunFacewire({"retarget", input, "--rig", FACEWIRE_SOURCE_DIR "/app/share/otto.toml",
                     "--profile", FACEWIRE_SOURCE_DIR "/app/share/average.profile", "--neutral",
                     "0:3", "--out", scratch.Path("out.csv")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return scratch.Read("out.csv");
  };
  const std::string from_video = rows(clip);
  const std::string from_file = rows(seen);
  EXPECT_EQ(std::ranges::count(from_file, '\n'), 7);
  ASSERT_EQ(from_video.substr(0, from_video.find('\n')), from_file.substr(0, from_file.find('\n')));
  const auto last = [](const std::string& text) {
    std::vector<double> numbers;
    std::size_t at = text.find("tracking,", text.rfind('\n', text.size() - 2)) + 9;
    for (; at < text.size(); at = text.find(',', at) + 1) {
      numbers.push_back(std::stod(text.substr(at)));
      if (text.find(',', at) == std::string::npos) break;
    }
    return numbers;
  };
  const auto expected = last(from_video);
  const auto actual = last(from_file);
  ASSERT_EQ(expected.size(), actual.size());
  ASSERT_GT(actual.size(), 20U);
  for (std::size_t i = 0; i < actual.size(); ++i) EXPECT_NEAR(actual[i], expected[i], 0.02) << i;
  EXPECT_EQ(RunFacewire({"neutral-of", seen, "--frames", "0:3", "--out", scratch.Path("n")}).code,
            0);
}

}  // namespace
}  // namespace facewire::tools
