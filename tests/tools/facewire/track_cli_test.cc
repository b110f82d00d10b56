#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(FacewireTrack, WritesALineAFrameWithEveryLandmark) {
  const Scratch scratch;
  const Outcome outcome =
      RunFacewire({"track", ShortClip(scratch, 5), "--out", scratch.Path("f.jsonl")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string lines = scratch.Read("f.jsonl");
  EXPECT_EQ(std::ranges::count(lines, '\n'), 5);
  EXPECT_THAT(lines, StartsWith("{\"frame\":0,\"t_us\":0,\"state\":\"tracking\",\"presence\":"));
  EXPECT_THAT(lines, HasSubstr("\n{\"frame\":4,\"t_us\":166667,"));
  const std::string first = lines.substr(0, lines.find('\n'));
  EXPECT_EQ(std::ranges::count(first, '['), 1 + 478);
}

TEST(FacewireTrack, OffersTheLightModelAndTheFilter) {
  const Scratch scratch;
  const Outcome outcome = RunFacewire({"track", ShortClip(scratch, 3), "--model", "mesh",
                                       "--filtered", "--out", scratch.Path("f.jsonl")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string lines = scratch.Read("f.jsonl");
  EXPECT_EQ(std::ranges::count(lines.substr(0, lines.find('\n')), '['), 1 + 468);
}

TEST(FacewireTrack, PlaysWhatIsThereOfAVideoThatBreaksOff) {
  const Scratch scratch;
  std::ifstream whole(ShortClip(scratch, 20), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(whole)),
                          std::istreambuf_iterator<char>());
  const std::string cut = scratch.Write("cut.avi", bytes.substr(0, bytes.size() / 2));
  const Outcome outcome = RunFacewire({"track", cut, "--out", scratch.Path("f.jsonl")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto frames = std::ranges::count(scratch.Read("f.jsonl"), '\n');
  EXPECT_GT(frames, 3);
  EXPECT_LT(frames, 20);
}

}  // namespace
}  // namespace facewire::tools
