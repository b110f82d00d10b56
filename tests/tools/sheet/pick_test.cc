#include "tools/sheet/pick.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "tests/tools/sheet/rigs.h"

namespace facewire::tools {
namespace {

using testing::ElementsAre;
using testing::Field;

// Ten seconds at 25 frames a second of a neutral pose.
struct Context {
  Rig rig = BoneRig();
  std::vector<RigPose> poses = std::vector<RigPose>(250, rig.NeutralPose());

  Context() {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].captured = Time{std::chrono::milliseconds(40 * i)};
      Set(rig, poses[i], "neck.yaw", 1);  // never quite calm ...
    }
    Set(rig, poses[0], "neck.yaw", 0);  // ... but here
  }
  std::vector<Pick> Call(std::size_t count = 6) { return PickMoments(rig, poses, count); }
};

TEST(PickMoments, FindsTheCalmestPoseAndTheExtremesInTheOrderOfTime) {
  Context context;
  Set(context.rig, context.poses[200], "upper_lid_L.pitch", 45);
  Set(context.rig, context.poses[200], "upper_lid_R.pitch", 45);
  Set(context.rig, context.poses[100], "jaw.pitch", 20);
  Set(context.rig, context.poses[101], "jaw.pitch", 18);
  EXPECT_THAT(
      context.Call(),
      ElementsAre(testing::AllOf(Field(&Pick::index, 0), Field(&Pick::caption, "calm")),
                  testing::AllOf(Field(&Pick::index, 100), Field(&Pick::caption, "mouth open")),
                  testing::AllOf(Field(&Pick::index, 200), Field(&Pick::caption, "eyes shut"))));
}

TEST(PickMoments, LeavesOutWhatHardlyOccursAndAWink) {
  Context context;
  Set(context.rig, context.poses[100], "jaw.pitch", 3);
  Set(context.rig, context.poses[200], "upper_lid_L.pitch", 45);
  EXPECT_EQ(context.Call().size(), 1U);
}

TEST(PickMoments, KeepsHalfASecondBetweenTwo) {
  Context context;
  Set(context.rig, context.poses[100], "jaw.pitch", 24);
  Set(context.rig, context.poses[105], "neck.yaw", 50);
  Set(context.rig, context.poses[113], "neck.yaw", 40);
  EXPECT_THAT(context.Call(), ElementsAre(Field(&Pick::index, 0), Field(&Pick::index, 100),
                                          Field(&Pick::index, 113)));
}

TEST(PickMoments, GivesAtMostWhatIsAskedForAndNothingForNothing) {
  Context context;
  Set(context.rig, context.poses[100], "jaw.pitch", 24);
  EXPECT_EQ(context.Call(1).size(), 1U);
  EXPECT_TRUE(context.Call(0).empty());
  context.poses.clear();
  EXPECT_TRUE(context.Call().empty());
}

}  // namespace
}  // namespace facewire::tools
