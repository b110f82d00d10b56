#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string ReadFileOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(FacewireCli, HelpsAndTellsItsVersion) {
  const Outcome help = RunFacewire({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(RunFacewire({"--version"}).out, StartsWith("facewire "));
  for (const char* command : {"track", "record", "pick", "retarget", "neutral-of", "train",
                              "monitor", "sheet", "doctor"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
    const Outcome own = RunFacewire({command, "--help"});
    EXPECT_EQ(own.code, 0) << command;
    EXPECT_THAT(own.out, HasSubstr("Usage: ")) << command;
  }
}

// Whatever is wrong with what was given: exit code 2, one line that says it, and no output file.
TEST(FacewireCli, AnswersBadInputWithOneLineAndExitCode2) {
  const Scratch scratch;
  const std::string out = scratch.Path("out.jsonl");
  const std::string clip = FACEWIRE_ASSETS "/footage/franck.mp4";
  const std::string no_video = scratch.Write("no_video.mp4", "this is text");
  const std::string rig =
      scratch.Write("rig.toml", "name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\n");
  const std::string markers = scratch.Write("m.csv", "a_x,a_y,a_z\n1,2,3\n");
  const std::string no_landmark =
      scratch.Write("elbow.toml", "name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = \"elbow\"\n");
  const std::string unknown_key = scratch.Write(
      "key.toml", "name = \"r\"\ncolour = \"red\"\n[[parameter]]\nname = \"jawOpen\"\n");
  std::string profile = ReadFileOf(FACEWIRE_SOURCE_DIR "/app/share/average.profile");
  profile[8] = 99;  // behind the magic: the version
  const std::string later_profile = scratch.Write("later.profile", profile);
  const std::string cut_networks = scratch.Path("cut");
  std::filesystem::copy(FACEWIRE_ASSETS "/networks", cut_networks);
  std::filesystem::resize_file(cut_networks + "/face_landmark_with_attention.tflite", 1000);
  const std::string odd_networks = scratch.Path("odd");
  std::filesystem::copy(FACEWIRE_ASSETS "/networks", odd_networks);
  std::string network = ReadFileOf(odd_networks + "/face_landmark_with_attention.tflite");
  network[network.size() / 2] ^= 1;
  scratch.Write("odd/face_landmark_with_attention.tflite", network);
  struct Case {
    std::vector<std::string> arguments;
    std::string says;
  };
  const Case cases[] = {
      {{}, "subcommand is required"},
      {{"dance"}, "there is no 'facewire dance'; see facewire --help"},
      {{"rig", "dance"}, "there is no 'facewire rig dance'; see facewire rig --help"},
      {{"rig"}, "see facewire rig --help"},
      {{"rig", "import", no_video}, "--out is required; see facewire rig import --help"},
      {{"track", no_video}, "--out is required"},
      {{"track", no_video, "--out", out}, "no_video.mp4"},
      {{"track", "/nowhere.mp4", "--out", out}, "/nowhere.mp4"},
      {{"track", "libcamera:of-nobody", "--out", out}, "libcamera:of-nobody: "},
      {{"track", "v4l2:/dev/no_such_camera", "--out", out}, "/dev/no_such_camera"},
      {{"track", no_video, "--out", out, "--model", "huge"}, "huge"},
      {{"track", no_video, "--out", out, "--networks", "/nowhere"}, "/nowhere"},
      {{"track", clip, "--out", out, "--networks", cut_networks},
       "face_landmark_with_attention.tflite"},
      {{"track", clip, "--out", out, "--networks", odd_networks}, "SHA-256"},
      {{"retarget", clip, "--rig", no_landmark, "--out", out},
       "elbow.toml:4:12: bone[0].landmark: no landmark \"elbow\""},
      {{"retarget", clip, "--rig", unknown_key, "--out", out}, "unknown key \"colour\""},
      {{"retarget", clip, "--rig", rig, "--profile", later_profile, "--out", out},
       "later.profile: the profile is of version 99"},
      {{"monitor", "/dev/no_such_port", "--csv", out}, "/dev/no_such_port"},
      {{"monitor", "/dev/no_such_port", "--baud", "7"}, "--baud"},
      {{"retarget", markers, "--rig", rig, "--out", out}, "--profile"},
      {{"retarget", no_video, "--rig", "/nowhere.toml", "--out", out}, "/nowhere.toml"},
      {{"retarget", no_video, "--rig", rig, "--neutral", "9:3", "--out", out}, "--neutral 9:3"},
      {{"retarget", no_video, "--rig", rig, "--profile", no_video, "--out", out}, "no_video.mp4"},
      {{"retarget", "v4l2:/dev/video0", "--rig", rig, "--out", out}, "takes a recording"},
      {{"sheet", markers, "--video", no_video, "--rig", rig, "--out", out}, "not a recording"},
      {{"neutral-of", no_video, "--frames", "x", "--out", out}, "--frames x"},
  };
  const std::size_t files = scratch.Files();
  for (const Case& bad : cases) {
    const Outcome outcome = RunFacewire(bad.arguments);
    EXPECT_EQ(outcome.code, 2) << bad.says << ": " << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("facewire: ")) << bad.says;
    EXPECT_THAT(outcome.err, HasSubstr(bad.says));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(scratch.Files(), files);
}

}  // namespace
}  // namespace facewire::tools
