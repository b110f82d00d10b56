#include "app/profile_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "app/checked_file.h"
#include "tests/app/scratch.h"
#include "tests/core/retarget/training_example.h"

namespace facewire::app {
namespace {

using retarget::TrainingExample;
using testing::HasSubstr;

TrainingSet Example() {
  const TrainingExample example;
  return {example.markers,      example.signals, example.samples,
          example.targets,      example.regions, 4,
          example.average_user, example.weights};
}

TEST(ProfileFile, IsReadAsItWasWritten) {
  const Scratch scratch;
  TrainingSet written = Example();
  written.regions[1].method = retarget::Method::kNnls;
  written.regions[1].nnls.ridge = 0.25F;
  written.weights = {1, 2, 3, 4, 1000, 6, 7, 8, 9};
  SaveProfile(scratch / "a.profile", written);
  const TrainingSet read = ReadTrainingSet(scratch / "a.profile");
  EXPECT_EQ(read.markers, written.markers);
  EXPECT_EQ(read.signals, written.signals);
  EXPECT_EQ(read.samples, written.samples);
  EXPECT_EQ(read.targets, written.targets);
  EXPECT_EQ(read.weights, written.weights);
  EXPECT_EQ(read.neutral_sample, 4U);
  EXPECT_TRUE(read.average_user);
  ASSERT_EQ(read.regions.size(), 2U);
  EXPECT_EQ(read.regions[1].name.view(), "mouth");
  EXPECT_EQ(read.regions[1].rbf.smoothing, written.regions[1].rbf.smoothing);
  EXPECT_EQ(read.regions[1].rbf.tail, rbf::Tail::kLinear);
  EXPECT_EQ(read.regions[0].method, retarget::Method::kRbf);
  EXPECT_EQ(read.regions[1].method, retarget::Method::kNnls);
  EXPECT_EQ(read.regions[1].nnls.ridge, 0.25F);
  EXPECT_EQ(read.regions[1].gaps[0].lower, 3);
  SaveProfile(scratch / "b.profile", read);
  EXPECT_EQ(Scratch::Read(scratch / "a.profile"), Scratch::Read(scratch / "b.profile"));
}

TEST(ProfileFile, ALoadedProfileGivesWhatWasTrained) {
  const Scratch scratch;
  SaveProfile(scratch / "a.profile", Example());
  const auto profile = LoadProfile(scratch / "a.profile");
  std::array<float, 2> signals{};
  profile->mapping().Evaluate(TrainingExample::Points(0.5F, 1), signals);
  EXPECT_NEAR(signals[0], 0.5F, 0.05F);
  EXPECT_NEAR(signals[1], 1, 0.05F);
}

TEST(ProfileFile, NamesTheRowsThatCoincide) {
  TrainingSet twice = Example();
  twice.regions.resize(1);
  twice.regions[0].rbf = {.epsilon = 1};
  TrainingExample::Fill(twice.regions[0].outputs, {0, 1});
  const std::string message = BadInputOf([&] { Profile(twice, "some.csv"); });
  EXPECT_THAT(message, HasSubstr("some.csv: in region \"eye\" rows 1 and 2 have the same markers"));
}

TEST(ProfileFile, SaysWhatIsWrongWithAFile) {
  const Scratch scratch;
  SaveProfile(scratch / "a.profile", Example());
  const std::string good = Scratch::Read(scratch / "a.profile");
  const auto message = [&](const std::string& content) {
    const auto path = scratch.Write("bad.profile", content);
    return BadInputOf([&] { LoadProfile(path); });
  };
  EXPECT_THAT(BadInputOf([&] { LoadProfile(scratch / "none.profile"); }),
              HasSubstr("none.profile: there is no such profile"));
  EXPECT_THAT(message("{}"), HasSubstr("not a facewire profile"));
  EXPECT_THAT(message(good.substr(0, good.size() / 2)), HasSubstr("truncated"));
  std::string damaged = good;
  damaged[good.size() / 2] = static_cast<char>(damaged[good.size() / 2] ^ 8);
  EXPECT_THAT(message(damaged), HasSubstr("checksum is wrong"));
  std::string newer = good;
  newer[8] = 9;
  EXPECT_THAT(message(newer), HasSubstr("of version 9, this program reads version 2"));
  std::string older = good;
  older[8] = 1;
  EXPECT_THAT(message(older), HasSubstr("of version 1, this program reads version 2; make it again "
                                        "with facewire train"));
}

// A payload that lies, under a right checksum: any byte may be anything.
TEST(ProfileFile, NoPayloadCrashesTheReader) {
  const Scratch scratch;
  SaveProfile(scratch / "a.profile", Example());
  const std::string good = Scratch::Read(scratch / "a.profile");
  const std::string payload = good.substr(16, good.size() - 20);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < payload.size(); ++i) {
    std::string bad = payload;
    bad[i] = static_cast<char>(bad[i] ^ 0xFF);
    const auto bytes = std::as_bytes(std::span<const char>(bad));
    std::string sealed;
    for (const std::byte b : Seal({"FWPROFIL", 2, "", ""}, bytes)) sealed += static_cast<char>(b);
    const auto path = scratch.Write("bad.profile", sealed);
    try {
      LoadProfile(path);
    } catch (const BadInput&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0U);
}

TEST(DefaultProfile, GivesTheNamesThatRigsAreDrivenBy) {
  const auto profile = LoadProfile(FACEWIRE_SOURCE_DIR "/app/share/average.profile");
  const auto signals = profile->mapping().signals();
  for (const char* name :
       {"jawOpen", "mouthSmileLeft", "mouthSmileRight", "mouthPucker", "eyeBlinkLeft",
        "eyeBlinkRight", "browInnerUp", "browDownLeft", "browDownRight"})
    EXPECT_TRUE(std::ranges::any_of(signals, [&](const ShortName& s) { return s.view() == name; }))
        << name;
  EXPECT_EQ(signals.size(), 51U);
  EXPECT_TRUE(profile->mapping().average_user());
  EXPECT_TRUE(profile->mapping().reads_landmarks());
}

TEST(DefaultProfile, TheAverageFaceAtRestGivesSmallSignals) {
  const auto profile = LoadProfile(FACEWIRE_SOURCE_DIR "/app/share/average.profile");
  std::vector<float> signals(profile->mapping().signals().size());
  profile->mapping().Evaluate(profile->mapping().neutral_cm(), signals);
  for (std::size_t i = 0; i < signals.size(); ++i)
    EXPECT_LT(signals[i], 0.2F) << profile->mapping().signals()[i].view();
}

TEST(DefaultProfile, ClosingOneLidBlinksThatEyeAndLeavesTheMouthAlone) {
  const auto profile = LoadProfile(FACEWIRE_SOURCE_DIR "/app/share/average.profile");
  const auto& mapping = profile->mapping();
  const auto at = [&](std::span<const Point3> points, std::string_view name) {
    std::vector<float> signals(mapping.signals().size());
    mapping.Evaluate(points, signals);
    const auto found = std::ranges::find_if(mapping.signals(),
                                            [&](const ShortName& s) { return s.view() == name; });
    return signals[static_cast<std::size_t>(found - mapping.signals().begin())];
  };
  // The left eye's upper lid, lowered onto the lower one.
  std::vector<Point3> points(mapping.neutral_cm().begin(), mapping.neutral_cm().end());
  const auto index = [&](std::int16_t landmark) {
    return static_cast<std::size_t>(std::ranges::find(mapping.point_indices(), landmark) -
                                    mapping.point_indices().begin());
  };
  const std::array<std::array<std::int16_t, 2>, 7> lids = {
      {{398, 382}, {384, 381}, {385, 380}, {386, 374}, {387, 373}, {388, 390}, {466, 249}}};
  for (const auto& [upper, lower] : lids) points[index(upper)] = points[index(lower)];
  EXPECT_GT(at(points, "eyeBlinkLeft"), 0.7F);
  EXPECT_LT(at(points, "eyeBlinkRight"), 0.2F);
  EXPECT_EQ(at(points, "jawOpen"), at(mapping.neutral_cm(), "jawOpen"));
  EXPECT_EQ(at(points, "mouthSmileLeft"), at(mapping.neutral_cm(), "mouthSmileLeft"));
}

}  // namespace
}  // namespace facewire::app
