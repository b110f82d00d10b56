#include "core/frame_path/frame_path.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "app/networks.h"
#include "hal/fake/fake_clock.h"
#include "hal/replay/replay_camera.h"
#include "tests/support/allocation_counter.h"

namespace facewire {
namespace {

// The frame path with the real networks, and a rig whose neck follows the head and whose jaw the
// chin.
class Context {
 public:
  Context() {
    const app::Networks networks =
        app::LoadNetworks(FACEWIRE_ASSETS "/networks", track::Model::kAttention);
    EXPECT_TRUE(path.Load(networks.files(), arena));
    struct {
      const char* name;
      Point3 rest_cm;
      std::int16_t landmark;
    } const bones[] = {{"jaw", {0, -9.4F, 4.3F}, 152},
                       {"nose", {0, -1.1F, 7.5F}, 1},
                       {"eye_L", {4.4F, 2.7F, 3.2F}, 263},
                       {"eye_R", {-4.4F, 2.7F, 3.2F}, 33},
                       {"forehead", {0, 8.3F, 4.5F}, 10}};
    for (const auto& bone : bones) {
      EXPECT_TRUE(rig.bones.try_push({*ShortName::From(bone.name), bone.rest_cm, bone.landmark}));
    }
    Channel yaw;
    yaw.name = *ShortName::From("neck.yaw");
    yaw.min = -90;
    yaw.max = 90;
    EXPECT_TRUE(yaw.drives.try_push({*ShortName::From("head.yaw"), 1}));
    EXPECT_TRUE(rig.channels.try_push(yaw));
    EXPECT_TRUE(retargeter.Configure(rig, nullptr, arena));
    path.Use(retargeter);
  }
  Frame Picture() {
    const Result<Frame> frame = camera.Acquire(std::chrono::milliseconds(0));
    EXPECT_TRUE(frame);
    return *frame;
  }

  std::vector<std::byte> memory =
      std::vector<std::byte>(FramePath::RequiredBytes(track::Model::kAttention) +
                             retarget::Retargeter::RequiredBytes() + 256);
  Arena arena{memory};
  FramePath path{FramePathConfig{}};
  Rig rig;
  retarget::Retargeter retargeter;
  hal::fake::FakeClock clock;
  hal::replay::ReplayCamera camera{{.path = FACEWIRE_ASSETS "/footage/franck.mp4",
                                    .pace = hal::Pace::kFast,
                                    .memory_bytes = std::size_t{64} << 20U},
                                   clock};
};

TEST(FramePath, FollowsAFaceFromAPictureToTheRig) {
  Context c;
  ASSERT_TRUE(c.camera.Start());
  for (int i = 0; i < 10; ++i) {
    const Frame frame = c.Picture();
    const Result<Followed> followed = c.path.Update(frame);
    ASSERT_TRUE(followed) << i << ": " << Name(followed.error());
    EXPECT_EQ(followed->face.seq, frame.seq);
    EXPECT_EQ(followed->rig.seq, frame.seq);
    EXPECT_EQ(followed->rig.captured, frame.captured);
    EXPECT_EQ(followed->rig.count, 1U);
    EXPECT_LT(followed->face.camera_t_head_cm.z, -10) << "in front of the camera";
    EXPECT_EQ(SightOf(followed), state::Sight::kFace);
  }
}

TEST(FramePath, SaysNoFaceForAPictureWithoutOneAndFindsTheNext) {
  Context c;
  ASSERT_TRUE(c.camera.Start());
  ASSERT_TRUE(c.path.Update(c.Picture()));
  std::array<std::uint8_t, 64 * 64> grey{};
  Frame blank;
  blank.seq = 1;
  blank.image = {.width_px = 64, .height_px = 64};
  blank.image.planes[0] = {grey.data(), 64};
  const Result<Followed> lost = c.path.Update(blank);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error(), Errc::kNoFace);
  EXPECT_EQ(SightOf(lost), state::Sight::kNoFace);
  EXPECT_TRUE(c.path.Update(c.Picture()));
}

TEST(FramePath, AllocatesNothing) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c;
  ASSERT_TRUE(c.camera.Start());
  test::AllocationCounter counter;
  for (int i = 0; i < 60; ++i) {
    if (i == 5) counter.Arm();
    const Frame frame = c.Picture();
    (void)c.path.Update(frame);
  }
  counter.Disarm();
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
  counter.PrintFirst();
}

TEST(SightOf, TellsARejectedFaceFromNone) {
  EXPECT_EQ(SightOf(Errc::kRejected), state::Sight::kRejected);
  EXPECT_EQ(SightOf(Errc::kUnsupported), state::Sight::kNoFace);
}

}  // namespace
}  // namespace facewire
