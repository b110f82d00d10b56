#include "core/rig/rig.h"

#include <gtest/gtest.h>

#include <memory>

namespace facewire {
namespace {

class RigTest : public testing::Test {
 protected:
  void Add(std::string_view name, float neutral) {
    Channel channel;
    channel.name = *ShortName::From(name);
    channel.neutral = neutral;
    ASSERT_TRUE(rig_->channels.try_push(channel));
  }
  std::unique_ptr<Rig> rig_ = std::make_unique<Rig>();
};

TEST_F(RigTest, FindsChannelsByTheirWholeName) {
  Add("jawOpen", 0);
  Add("jaw.pitch", 5);
  EXPECT_EQ(rig_->FindChannel("jawOpen"), 0U);
  EXPECT_EQ(rig_->FindChannel("jaw.pitch"), 1U);
  EXPECT_EQ(rig_->FindChannel("jaw"), std::nullopt);
  EXPECT_EQ(rig_->FindChannel("jawOpen2"), std::nullopt);
  EXPECT_EQ(rig_->FindChannel("JawOpen"), std::nullopt);
  EXPECT_EQ(rig_->FindChannel(""), std::nullopt);
}

TEST_F(RigTest, OfTwoChannelsOfOneNameItFindsTheFirst) {
  Add("a", 1);
  Add("a", 2);
  EXPECT_EQ(rig_->FindChannel("a"), 0U);
}

TEST_F(RigTest, TheNeutralPoseHasOneValueForEveryChannel) {
  Add("a", 0.25F);
  Add("b", -3);
  const RigPose pose = rig_->NeutralPose();
  EXPECT_EQ(pose.count, 2U);
  EXPECT_EQ(pose.values[0], 0.25F);
  EXPECT_EQ(pose.values[1], -3.F);
  EXPECT_EQ(pose.seq, 0U);
  EXPECT_EQ(pose.captured, Time{});
}

TEST_F(RigTest, AnEmptyRigHasAnEmptyNeutralPose) {
  EXPECT_EQ(rig_->NeutralPose().count, 0U);
  EXPECT_EQ(rig_->FindChannel("a"), std::nullopt);
}

TEST_F(RigTest, HoldsAsManyChannelsAsAPose) {
  for (std::size_t i = 0; i < kMaxChannels; ++i) Add("c", static_cast<float>(i));
  EXPECT_FALSE(rig_->channels.try_push(Channel{}));
  EXPECT_EQ(rig_->NeutralPose().count, kMaxChannels);
  EXPECT_EQ(rig_->NeutralPose().values[kMaxChannels - 1], static_cast<float>(kMaxChannels - 1));
}

TEST(ChannelKindTest, EveryKindIsAPositionOrARotationOrAParameter) {
  EXPECT_FALSE(IsPosition(ChannelKind::kParameter) || IsRotation(ChannelKind::kParameter));
  for (auto kind : {ChannelKind::kPositionX, ChannelKind::kPositionY, ChannelKind::kPositionZ}) {
    EXPECT_TRUE(IsPosition(kind) && !IsRotation(kind));
  }
  for (auto kind : {ChannelKind::kPitch, ChannelKind::kYaw, ChannelKind::kRoll}) {
    EXPECT_TRUE(IsRotation(kind) && !IsPosition(kind));
  }
}

}  // namespace
}  // namespace facewire
