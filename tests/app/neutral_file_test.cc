#include "app/neutral_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using testing::HasSubstr;

retarget::Neutral SomeNeutral(std::size_t count) {
  retarget::Neutral neutral;
  neutral.count = count;
  for (std::size_t i = 0; i < count; ++i)
    neutral.points_cm[i] = {static_cast<float>(i), -0.5F, 1e-3F};
  neutral.camera_R_head = {0, 1, 0, -1, 0, 0, 0, 0, 1};
  neutral.camera_t_head_cm = {1, 2, -60};
  return neutral;
}

TEST(NeutralFile, IsReadAsItWasWritten) {
  const Scratch scratch;
  for (const std::size_t count : {kMaxLandmarks, kMeshLandmarks}) {
    const retarget::Neutral neutral = SomeNeutral(count);
    SaveNeutral(scratch / "neutral", neutral);
    const retarget::Neutral read = LoadNeutral(scratch / "neutral");
    EXPECT_EQ(read.count, count);
    EXPECT_EQ(read.points_cm, neutral.points_cm);
    EXPECT_EQ(read.camera_R_head, neutral.camera_R_head);
    EXPECT_EQ(read.camera_t_head_cm, neutral.camera_t_head_cm);
  }
}

TEST(NeutralFile, RefusesWhatIsMissingDamagedOrNotANeutral) {
  const Scratch scratch;
  EXPECT_THAT(BadInputOf([&] { LoadNeutral(scratch / "none"); }), HasSubstr("no such neutral"));
  SaveNeutral(scratch / "neutral", SomeNeutral(kMaxLandmarks));
  std::string content = Scratch::Read(scratch / "neutral");
  content[100] = static_cast<char>(content[100] ^ 1);
  const auto damaged = scratch.Write("damaged", content);
  EXPECT_THAT(BadInputOf([&] { LoadNeutral(damaged); }), HasSubstr("checksum"));
  const auto profile = scratch.Write("profile", "FWPROFIL................");
  EXPECT_THAT(BadInputOf([&] { LoadNeutral(profile); }), HasSubstr("not a facewire neutral"));
}

TEST(NeutralFile, RefusesNumbersThatAreNotFinite) {
  const Scratch scratch;
  retarget::Neutral neutral = SomeNeutral(kMaxLandmarks);
  neutral.points_cm[400].y = std::numeric_limits<float>::quiet_NaN();
  SaveNeutral(scratch / "neutral", neutral);
  EXPECT_THAT(BadInputOf([&] { LoadNeutral(scratch / "neutral"); }), HasSubstr("contradicts"));
}

}  // namespace
}  // namespace facewire::app
