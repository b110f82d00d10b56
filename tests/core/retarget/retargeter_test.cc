#include "core/retarget/retargeter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "tests/core/retarget/training_example.h"
#include "tests/support/allocation_counter.h"

namespace facewire::retarget {
namespace {

ShortName Named(std::string_view name) { return TrainingExample::Named(name); }

// The example's face as FacePose and Neutral: scaled, so that the performer is not the average.
std::unique_ptr<FacePose> Face(float blink, float open, float scale = 1) {
  auto face = std::make_unique<FacePose>();
  face->seq = 9;
  face->captured = Time(Duration(123));
  face->count = kMaxLandmarks;
  for (std::size_t i = 0; i < face->count; ++i)
    face->points_cm[i] = {static_cast<float>(i % 20), static_cast<float>(i / 20), 0};
  const auto points = TrainingExample::Points(blink, open);
  const std::array<std::size_t, 4> at = {386, 374, 13, 14};
  for (std::size_t i = 0; i < 4; ++i) face->points_cm[at[i]] = scale * points[i];
  face->points_cm[473] = face->points_cm[374];  // the iris, for profiles that read it
  return face;
}

Neutral NeutralOf(const FacePose& face) {
  return {face.count, face.points_cm, face.camera_R_head, face.camera_t_head_cm};
}

struct Context {
  ExampleMapping expressions;
  Rig rig;
  std::vector<std::byte> block = std::vector<std::byte>(Retargeter::RequiredBytes());
  Retargeter retargeter;

  Context() {
    EXPECT_TRUE(expressions.Configure({}));
    Bone jaw{Named("jaw"), {0, -10, 5}, 14};
    Bone lid{Named("lid"), {6, 7, 8}, 386};
    EXPECT_TRUE(rig.bones.try_push(jaw) && rig.bones.try_push(lid));
    AddChannel("blink", ChannelKind::kParameter, -1, 0, {{Named("blink"), 1}});
    AddChannel("jaw.y", ChannelKind::kPositionY, 0, 0, {});
    AddChannel("jaw.pitch", ChannelKind::kPitch, 0, 2, {{Named("open"), 20}, {Named("blink"), 5}});
    AddChannel("neck.yaw", ChannelKind::kYaw, -1, 0, {{Named("head.yaw"), 0.5F}});
    AddChannel("still", ChannelKind::kParameter, -1, 0.25F, {});
  }
  void AddChannel(std::string_view name, ChannelKind kind, std::int16_t bone, float neutral,
                  std::initializer_list<Drive> drives) {
    Channel channel;
    channel.name = Named(name);
    channel.kind = kind;
    channel.bone = bone;
    channel.neutral = neutral;
    for (const Drive& drive : drives) EXPECT_TRUE(channel.drives.try_push(drive));
    EXPECT_TRUE(rig.channels.try_push(channel));
  }
  Result<> Configure() {
    Arena arena(block);
    return retargeter.Configure(rig, &expressions.mapping, arena);
  }
};

TEST(Retargeter, ANeutralFaceGivesExactlyTheRestPose) {
  Context c;
  ASSERT_TRUE(c.Configure());
  const auto face = Face(0, 0, 1.3F);
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*face)));
  const RigPose pose = c.retargeter.Update(*face);
  EXPECT_EQ(pose.seq, 9U);
  EXPECT_EQ(pose.captured, Time(Duration(123)));
  EXPECT_EQ(pose.count, 5U);
  EXPECT_EQ(pose.values[1], 0) << "the bone is at rest";
  EXPECT_NEAR(pose.values[0], 0, 0.02F);
  EXPECT_NEAR(pose.values[2], 2, 0.5F);
  EXPECT_NEAR(pose.values[3], 0, 1e-4F);
  EXPECT_EQ(pose.values[4], 0.25F);
}

TEST(Retargeter, DrivesAddUpToTheirChannel) {
  Context c;
  ASSERT_TRUE(c.Configure());
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  const RigPose pose = c.retargeter.Update(*Face(1, 1));
  EXPECT_NEAR(pose.values[0], 1, 0.05F);
  EXPECT_NEAR(pose.values[2], 2 + 20 + 5, 1);
}

TEST(Retargeter, AChannelAnswersToItsSumAsItsResponseSays) {
  Context c;
  Channel& pitch = c.rig.channels[2];
  pitch.response.gain = 2;
  pitch.response.bias = 3;
  Channel& jaw = c.rig.channels[1];
  jaw.response.gain = -1;
  ASSERT_TRUE(c.Configure());
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  EXPECT_NEAR(c.retargeter.Update(*Face(0, 0)).values[2], 2 + 3, 1) << "a neutral face: the bias";
  const RigPose pose = c.retargeter.Update(*Face(1, 0.5F));
  EXPECT_NEAR(pose.values[2], 2 + 2 * (10 + 5) + 3, 2);
  EXPECT_GT(pose.values[1], 0.2F) << "a bone that follows its landmark, the other way round";
}

TEST(Retargeter, APerformerWithAnotherFaceIsTakenToTheAverage) {
  Context c;
  ASSERT_TRUE(c.Configure());
  const float scale = 1.4F;
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0, scale))));
  EXPECT_NEAR(c.retargeter.Update(*Face(1, 0, scale)).values[0], 1, 0.1F);
  EXPECT_NEAR(c.retargeter.Update(*Face(0.5F, 0, scale)).values[0], 0.5F, 0.1F);
}

TEST(Retargeter, AProfileOfOnesOwnReadsTheMotionFromTodaysNeutral) {
  TrainingExample example;
  example.average_user = false;
  Context c;
  ASSERT_TRUE(c.expressions.Configure(example));
  ASSERT_TRUE(c.Configure());
  const auto shifted = [](float blink, float open) {
    auto face = Face(blink, open);
    face->points_cm[386].y += 0.3F;  // markers that were glued on elsewhere today
    face->points_cm[14].y -= 0.4F;
    return face;
  };
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*shifted(0, 0))));
  EXPECT_NEAR(c.retargeter.Update(*shifted(0, 0)).values[0], 0, 0.02F);
  EXPECT_NEAR(c.retargeter.Update(*shifted(1, 0.5F)).values[0], 1, 0.05F);
  EXPECT_NEAR(c.retargeter.Update(*shifted(0, 0.5F)).values[2], 2 + 10, 0.5F);
}

TEST(Retargeter, BeforeTheFirstNeutralThePerformerCountsAsTheAverage) {
  Context c;
  ASSERT_TRUE(c.Configure());
  const RigPose pose = c.retargeter.Update(*Face(1, 0));
  EXPECT_NEAR(pose.values[0], 1, 0.05F);
  EXPECT_EQ(pose.values[1], 0);
}

TEST(Retargeter, BonesFollowTheirLandmarkWhenNoDriveMovesThem) {
  Context c;
  ASSERT_TRUE(c.Configure());
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  const float half = c.retargeter.Update(*Face(0, 0.2F)).values[1];
  const float full = c.retargeter.Update(*Face(0, 0.4F)).values[1];
  EXPECT_LT(half, -0.2F);
  EXPECT_LT(full, 1.5F * half);
}

TEST(Retargeter, TheHeadIsMeasuredFromWhereItWasInTheNeutral) {
  Context c;
  ASSERT_TRUE(c.Configure());
  const auto yawed = [](float degrees, Point3 at) {
    auto face = Face(0, 0);
    const float a = degrees * 3.14159265F / 180;
    face->camera_R_head = {std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a)};
    face->camera_t_head_cm = at;
    return face;
  };
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*yawed(10, {0, 0, -50}))));
  EXPECT_NEAR(c.retargeter.Update(*yawed(30, {0, 2, -50})).values[3], 0.5F * 20, 1e-2F);
  const auto signals = c.retargeter.signals();
  ASSERT_EQ(signals.size(), 2U + kHeadSignals.size());
  EXPECT_EQ(c.retargeter.signal_name(0), "blink");
  EXPECT_EQ(c.retargeter.signal_name(3), "head.yaw");
  EXPECT_NEAR(signals[3], 20, 1e-2F);
  EXPECT_NEAR(signals[6], 2, 1e-4F) << "head.y";
}

TEST(Retargeter, ANeutralThatCannotBeSolvedLeavesTheOldOne) {
  Context c;
  ASSERT_TRUE(c.Configure());
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  const RigPose before = c.retargeter.Update(*Face(0.7F, 0.4F));
  Neutral one_place;
  one_place.count = kMaxLandmarks;
  EXPECT_EQ(c.retargeter.SetNeutral(one_place).error(), Errc::kSingular);
  Neutral broken = NeutralOf(*Face(0, 0));
  broken.points_cm[100].x = std::numeric_limits<float>::infinity();
  EXPECT_EQ(c.retargeter.SetNeutral(broken).error(), Errc::kInvalidArgument);
  EXPECT_EQ(c.retargeter.SetNeutral(Neutral{}).error(), Errc::kInvalidArgument);
  EXPECT_EQ(c.retargeter.Update(*Face(0.7F, 0.4F)).values, before.values);
}

TEST(Retargeter, PointsThatTheLightTrackerDoesNotSeeCountAsUnmoved) {
  Context c;
  TrainingExample with_iris;
  with_iris.markers[1] = Named("lm473");
  ASSERT_TRUE(c.expressions.Configure(with_iris));
  ASSERT_TRUE(c.Configure());
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  auto mesh = Face(0, 1);
  mesh->count = kMeshLandmarks;
  mesh->points_cm[473] = {1e6F, 1e6F, 1e6F};  // beyond count: never read
  EXPECT_NEAR(c.retargeter.Update(*mesh).values[0], 0, 0.05F);
  EXPECT_NEAR(c.retargeter.signals()[1], 1, 0.05F) << "the mouth goes on";
}

TEST(Retargeter, WhatIsNotFiniteLeavesItsChannelsAtNeutral) {
  Context c;
  ASSERT_TRUE(c.Configure());
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  auto face = Face(1, 0);
  face->points_cm[14].y = std::numeric_limits<float>::quiet_NaN();
  face->camera_R_head.fill(std::numeric_limits<float>::quiet_NaN());
  const RigPose pose = c.retargeter.Update(*face);
  EXPECT_NEAR(pose.values[0], 1, 0.05F);
  EXPECT_EQ(pose.values[1], 0);
  EXPECT_EQ(pose.values[3], 0);
}

TEST(Retargeter, ASignalThatNobodyGivesIsNamed) {
  Context c;
  c.AddChannel("odd", ChannelKind::kParameter, -1, 0, {{Named("mouthWink"), 1}});
  const auto unknown = FirstUnknownSignal(c.rig, &c.expressions.mapping);
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->view(), "mouthWink");
  EXPECT_EQ(c.Configure().error(), Errc::kNotFound);
}

TEST(Retargeter, WithoutAProfileOnlyBonesAndTheHeadMove) {
  Context c;
  Rig rig;
  ASSERT_TRUE(rig.bones.try_push(c.rig.bones[0]));
  ASSERT_TRUE(rig.channels.try_push(c.rig.channels[1]));
  ASSERT_TRUE(rig.channels.try_push(c.rig.channels[3]));
  Arena arena(c.block);
  ASSERT_TRUE(c.retargeter.Configure(rig, nullptr, arena));
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  EXPECT_NEAR(c.retargeter.Update(*Face(0, 0.5F)).values[0], -1.5F, 0.05F);
  EXPECT_EQ(FirstUnknownSignal(c.rig, nullptr)->view(), "blink");
}

TEST(Retargeter, AnArenaThatIsTooSmallIsFull) {
  Context c;
  Arena small(std::span<std::byte>(c.block).first(c.block.size() / 2));
  EXPECT_EQ(c.retargeter.Configure(c.rig, &c.expressions.mapping, small).error(), Errc::kFull);
}

TEST(Retargeter, NeitherAFrameNorANewNeutralAllocates) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c;
  ASSERT_TRUE(c.Configure());
  const auto face = Face(0.3F, 0.6F);
  const Neutral neutral = NeutralOf(*Face(0, 0));
  test::AllocationCounter counter;
  counter.Arm();
  const bool solved = c.retargeter.SetNeutral(neutral).has_value();
  for (int i = 0; i < 10; ++i) c.retargeter.Update(*face);
  counter.Disarm();
  EXPECT_TRUE(solved);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

}  // namespace
}  // namespace facewire::retarget
