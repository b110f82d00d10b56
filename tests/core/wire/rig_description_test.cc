#include "core/wire/rig_description.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "tests/core/wire/test_rig.h"

namespace facewire::wire {
namespace {

std::vector<Message> Parts(const Rig& rig) {
  std::vector<Message> parts;
  for (std::size_t i = 0; i < DescriptionCount(rig); ++i) {
    parts.push_back(*Description(rig, RigId(rig), i));
  }
  return parts;
}

TEST(RigDescription, HasOneMessageForTheHeaderEachBoneAndEachChannel) {
  const Rig rig = TestRig();
  EXPECT_EQ(DescriptionCount(rig), 7U);
  EXPECT_EQ(Description(rig, 0, 7).error(), Errc::kOutOfRange);
  EXPECT_EQ(std::get<BoneDescription>(*Description(rig, 0, 2)).name.view(), "jaw");
  EXPECT_EQ(std::get<ChannelDescription>(*Description(rig, 0, 3)).name.view(), "jaw.pitch");
}

TEST(RigDescription, AHostPutsTheRigTogetherInAnyOrder) {
  const auto rig = std::make_unique<Rig>(TestRig());
  std::vector<Message> parts = Parts(*rig);
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::shuffle(parts.begin(), parts.end(), random);
    const auto host = std::make_unique<RigCollector>();
    // Twice around at most: what came before the header counts too.
    for (const Message& part : parts) {
      EXPECT_FALSE(host->Complete());
      EXPECT_TRUE(host->Add(part));
    }
    ASSERT_TRUE(host->Complete());
    EXPECT_EQ(host->rig_id(), RigId(*rig));
    EXPECT_EQ(RigId(host->rig()), RigId(*rig));
    EXPECT_EQ(host->rig().channels[1].max, 45.0F);
    EXPECT_EQ(host->rig().bones[1].rest_cm.y, -6.5F);
  }
}

TEST(RigDescription, OtherMessagesAndRepeatsDoNotDisturb) {
  const auto host = std::make_unique<RigCollector>();
  const Rig rig = TestRig();
  for (const Message& part : Parts(rig)) {
    EXPECT_TRUE(host->Add(part));
    EXPECT_TRUE(host->Add(part));
    EXPECT_FALSE(host->Add(Pose{}));
    EXPECT_FALSE(host->Add(Command{}));
  }
  EXPECT_TRUE(host->Complete());
  EXPECT_EQ(host->missing(), 0U);
}

TEST(RigDescription, ARigThatChangesStartsOver) {
  const auto host = std::make_unique<RigCollector>();
  Rig rig = TestRig();
  for (const Message& part : Parts(rig)) (void)host->Add(part);
  rig.channels[0].max = 30;
  const auto changed = Parts(rig);
  EXPECT_TRUE(host->Add(changed[1]));
  EXPECT_FALSE(host->Complete());
  for (const Message& part : changed) (void)host->Add(part);
  EXPECT_TRUE(host->Complete());
  EXPECT_EQ(host->rig().channels[0].max, 30.0F);
}

TEST(RigDescription, AnEmptyRigIsCompleteWithItsHeader) {
  const auto host = std::make_unique<RigCollector>();
  EXPECT_FALSE(host->Complete());
  EXPECT_TRUE(host->Add(*Description(Rig{}, 0, 0)));
  EXPECT_TRUE(host->Complete());
}

TEST(RigDescription, PartsBeyondTheHeadersCountsAreRefused) {
  const auto host = std::make_unique<RigCollector>();
  (void)host->Add(RigHeader{.bones = 1, .channels = 1});
  EXPECT_FALSE(host->Add(BoneDescription{.index = 1}));
  EXPECT_FALSE(host->Add(ChannelDescription{.index = 1}));
  EXPECT_FALSE(host->Add(RigHeader{.bones = 255, .channels = 255}));
  EXPECT_EQ(host->missing(), 2U);
}

TEST(RigId, ChangesWithEverythingThatAHostSees) {
  const Rig rig = TestRig();
  std::vector<std::uint32_t> ids{RigId(rig)};
  const auto with = [&](auto change) {
    Rig other = rig;
    change(other);
    ids.push_back(RigId(other));
  };
  with([](Rig& r) { r.name = *ShortName::From("other"); });
  with([](Rig& r) { r.bones[0].rest_cm.z = 1; });
  with([](Rig& r) { r.bones[0].name = *ShortName::From("skull"); });
  with([](Rig& r) { r.channels[0].min = -3; });
  with([](Rig& r) { r.channels[0].neutral = 2; });
  with([](Rig& r) { r.channels[0].bone = 0; });
  with([](Rig& r) { r.channels[0].kind = ChannelKind::kRoll; });
  with([](Rig& r) { std::swap(r.channels[0], r.channels[1]); });
  with([](Rig& r) { (void)r.channels.try_resize(3); });
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
}

TEST(RigId, DoesNotChangeWithWhatAHostDoesNotSee) {
  Rig rig = TestRig();
  const std::uint32_t id = RigId(rig);
  rig.channels[0].max_speed_per_s = 100;
  rig.bones[0].landmark = 152;
  (void)rig.channels[0].drives.try_push({.signal = *ShortName::From("jawOpen")});
  EXPECT_EQ(RigId(rig), id);
}

}  // namespace
}  // namespace facewire::wire
