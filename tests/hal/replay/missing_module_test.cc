#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "hal/fake/fake_clock.h"
#include "hal/replay/replay_camera.h"
#include "tests/hal/far_end.h"

namespace facewire::hal::replay {
namespace {

// What an incomplete installation would meet.
TEST(ReplayCameraWithoutItsModule, SaysInOneLineWhatIsMissingAndWhatInstallsIt) {
  const test::TemporaryFolder folder;
  const std::string clip = folder.File("clip.avi");
  std::ofstream(clip) << "something";
  fake::FakeClock clock{Time{}};
  ReplayCamera camera({.path = clip}, clock);

  EXPECT_EQ(camera.Start().error(), Errc::kNotFound);

  const std::string reason(camera.reason());
  EXPECT_NE(reason.find("facewire_video_decoder.so"), std::string::npos) << reason;
  EXPECT_NE(reason.find("the package facewire"), std::string::npos) << reason;
  EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
}

TEST(ReplayCameraWithoutItsModule, StillSaysFirstThatThereIsNoSuchVideo) {
  fake::FakeClock clock{Time{}};
  ReplayCamera camera({.path = "no/such/clip.avi"}, clock);
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound);
  EXPECT_NE(camera.reason().find("no/such/clip.avi"), std::string::npos);
}

}  // namespace
}  // namespace facewire::hal::replay
