// Retargeter with a personal profile.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "core/retarget/retargeter.h"
#include "tests/core/retarget/training_example.h"
#include "tests/support/allocation_counter.h"

namespace facewire::retarget {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

ShortName Named(std::string_view name) { return TrainingExample::Named(name); }

// The example's face; `scale`: seen from another distance, as another camera has it.
std::unique_ptr<FacePose> Face(float blink, float open, float scale = 1) {
  auto face = std::make_unique<FacePose>();
  face->count = kMaxLandmarks;
  const auto points = TrainingExample::Points(blink, open);
  const std::array<std::size_t, 4> at = {386, 374, 13, 14};
  for (std::size_t i = 0; i < 4; ++i) face->points_cm[at[i]] = scale * points[i];
  return face;
}

Neutral NeutralOf(const FacePose& face) {
  return {face.count, face.points_cm, face.camera_R_head, face.camera_t_head_cm};
}

// The average says how far lids and lips are closed and open ("blink", "open"); the person's own
// profile wants half of the blink, and calls the lips "mutter".
TrainingExample PersonalExample() {
  TrainingExample example;
  example.average_user = false;
  example.signals[1] = Named("mutter");
  for (std::size_t i = 0; i < example.targets.size(); i += 2) example.targets[i] *= 0.5F;
  return example;
}

struct Context {
  ExampleMapping average, personal;
  Rig rig;
  std::vector<std::byte> block = std::vector<std::byte>(Retargeter::RequiredBytes());
  Retargeter retargeter;
  Time now{hours(1)};

  Context() {
    EXPECT_TRUE(average.Configure({}));
    EXPECT_TRUE(personal.Configure(PersonalExample()));
    for (const char* name : {"blink", "open", "mutter"}) {
      Channel channel;
      channel.name = Named(name);
      EXPECT_TRUE(channel.drives.try_push({Named(name), 1}));
      EXPECT_TRUE(rig.channels.try_push(channel));
    }
  }
  Result<> Configure() {
    Arena arena(block);
    return retargeter.Configure(rig, &average.mapping, arena, &personal.mapping);
  }
  void Start(float blend) {
    ASSERT_TRUE(Configure());
    retargeter.SetBlend(blend);
    ASSERT_TRUE(retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  }
  RigPose Call(const std::unique_ptr<FacePose>& face, Duration later = milliseconds(20)) {
    face->captured = now += later;
    return retargeter.Update(*face);
  }
};

TEST(PersonalProfile, IsBlendedByTheNamesOfSignals) {
  struct Row {
    float blend, blink, open, mutter;
    const char* reason;
  };
  for (const Row& row : {Row{0, 1, 1, 0, "as if there were none"},
                         Row{0.5F, 0.75F, 1, 0.5F, "shared ones in the middle"},
                         Row{1, 0.5F, 1, 1, "what only the average gives stays"}}) {
    Context c;
    c.Start(row.blend);
    const RigPose pose = c.Call(Face(1, 1));
    EXPECT_NEAR(pose.values[0], row.blink, 0.05F) << row.reason;
    EXPECT_NEAR(pose.values[1], row.open, 0.05F) << row.reason;
    EXPECT_NEAR(pose.values[2], row.mutter, 0.05F) << row.reason;
  }
}

TEST(PersonalProfile, ItsOwnSignalsComeAfterTheOthers) {
  Context c;
  c.Start(1);
  c.Call(Face(1, 1));
  ASSERT_EQ(c.retargeter.signals().size(), 3 + kHeadSignals.size());
  const char* const names[] = {"blink", "open", "mutter", "head.pitch"};
  for (std::size_t i = 0; i < std::size(names); ++i)
    EXPECT_EQ(c.retargeter.signal_name(i), names[i]);
  EXPECT_NEAR(c.retargeter.signals()[2], 1, 0.05F);
}

TEST(PersonalProfile, CountsInFullUnlessToldOtherwise) {
  Context c;
  ASSERT_TRUE(c.Configure());
  EXPECT_TRUE(c.retargeter.has_personal());
  EXPECT_EQ(c.retargeter.blend(), 1.F);
  EXPECT_NEAR(c.Call(Face(1, 0)).values[0], 0.5F, 0.05F) << "also before the first neutral";
}

TEST(PersonalProfile, AThrownLeverDoesNotThrowThePuppet) {
  Context c;
  c.Start(0);
  float last = c.Call(Face(1, 1)).values[2];
  EXPECT_EQ(last, 0);
  c.retargeter.SetBlend(1);
  EXPECT_EQ(c.retargeter.blend(), 1.F) << "where it goes to";
  for (int ms = 20; ms < 500; ms += 20) {
    const float value = c.Call(Face(1, 1)).values[2];
    ASSERT_NEAR(value - last, 0.04F, 0.005F) << ms << " ms";
    last = value;
  }
  EXPECT_NEAR(c.Call(Face(1, 1)).values[2], 1, 0.05F);
  const float there = c.Call(Face(1, 1)).values[2];
  EXPECT_EQ(c.Call(Face(1, 1)).values[2], there) << "and no further";
}

TEST(PersonalProfile, NeitherASilenceNorAnotherClockMakesTheBlendLeap) {
  Context c;
  c.Start(0);
  c.Call(Face(1, 1));
  c.retargeter.SetBlend(1);
  EXPECT_EQ(c.Call(Face(1, 1), milliseconds(0)).values[2], 0.F);
  EXPECT_EQ(c.Call(Face(1, 1), -hours(1)).values[2], 0.F);
  EXPECT_NEAR(c.Call(Face(1, 1), hours(5)).values[2], 0.2F, 0.02F) << "as 100 ms";
  EXPECT_NEAR(c.Call(Face(1, 1), milliseconds(50)).values[2], 0.3F, 0.02F);
}

TEST(PersonalProfile, ABlendBeyondItsEndsIsClampedAndNanChangesNothing) {
  Context c;
  c.Start(0.25F);
  c.retargeter.SetBlend(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(c.retargeter.blend(), 0.25F);
  c.retargeter.SetBlend(7);
  EXPECT_EQ(c.retargeter.blend(), 1.F);
  c.retargeter.SetBlend(-std::numeric_limits<float>::infinity());
  EXPECT_EQ(c.retargeter.blend(), 0.F);
}

TEST(PersonalProfile, SurvivesAnotherDistanceOfTheCamera) {
  Context c;
  ASSERT_TRUE(c.Configure());
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0, 1.4F))));
  const RigPose rest = c.Call(Face(0, 0, 1.4F));
  EXPECT_NEAR(rest.values[0], 0, 0.02F);
  EXPECT_NEAR(rest.values[2], 0, 0.02F);
  const RigPose half = c.Call(Face(0.5F, 0.5F, 1.4F));
  EXPECT_NEAR(half.values[0], 0.25F, 0.04F);
  EXPECT_NEAR(half.values[2], 0.5F, 0.08F);
}

TEST(PersonalProfile, StandsAloneWithoutAnother) {
  Context c;
  Rig rig;
  ASSERT_TRUE(rig.channels.try_push(c.rig.channels[0]));
  Arena arena(c.block);
  EXPECT_EQ(FirstUnknownSignal(c.rig, nullptr, &c.personal.mapping), Named("open"));
  ASSERT_TRUE(c.retargeter.Configure(rig, nullptr, arena, &c.personal.mapping));
  c.retargeter.SetBlend(0.5F);
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*Face(0, 0))));
  EXPECT_NEAR(c.Call(Face(1, 0)).values[0], 0.25F, 0.03F);
}

TEST(PersonalProfile, NoSignalInCommonIsFine) {
  Context c;
  TrainingExample example = PersonalExample();
  example.signals[0] = Named("wink");
  ASSERT_TRUE(c.personal.Configure(example));
  c.Start(1);
  const RigPose pose = c.Call(Face(1, 1));
  EXPECT_NEAR(pose.values[0], 1, 0.05F);
  EXPECT_NEAR(pose.values[2], 1, 0.05F);
}

TEST(PersonalProfile, MustReadWhatTheFaceHolds) {
  Context c;
  TrainingExample markers = PersonalExample();
  for (std::size_t i = 0; i < 4; ++i) markers.markers[i] = Named("m" + std::to_string(i));
  ASSERT_TRUE(c.personal.Configure(markers));
  EXPECT_EQ(c.Configure().error(), Errc::kUnsupported) << "landmarks and a marker file's";
}

TEST(PersonalProfile, FindsAMarkerFilesMarkersByName) {
  const std::array<const char*, 4> names = {"upper_lid", "lower_lid", "upper_lip", "lower_lip"};
  TrainingExample average;
  average.average_user = false;
  TrainingExample personal = PersonalExample();
  // The same four markers; the personal profile has the lips' first.
  for (std::size_t i = 0; i < 4; ++i) {
    average.markers[i] = Named(names[i]);
    personal.markers[i] = Named(names[(i + 2) % 4]);
  }
  for (std::size_t row = 0; row < personal.samples.size(); row += 12)
    std::rotate(personal.samples.begin() + static_cast<std::ptrdiff_t>(row),
                personal.samples.begin() + static_cast<std::ptrdiff_t>(row + 6),
                personal.samples.begin() + static_cast<std::ptrdiff_t>(row + 12));
  TrainingExample::Fill(personal.regions[0].points, {2, 3});
  TrainingExample::Fill(personal.regions[0].origin, {3});
  TrainingExample::Fill(personal.regions[1].points, {0, 1});
  personal.regions[1].gaps.clear();
  Context c;
  ASSERT_TRUE(c.average.Configure(average));
  ASSERT_TRUE(c.personal.Configure(personal));
  ASSERT_TRUE(c.Configure());
  const auto face = [](float blink, float open) {
    auto made = std::make_unique<FacePose>();
    made->count = 4;
    const auto points = TrainingExample::Points(blink, open);
    std::ranges::copy(points, made->points_cm.begin());
    return made;
  };
  ASSERT_TRUE(c.retargeter.SetNeutral(NeutralOf(*face(0, 0))));
  const RigPose pose = c.Call(face(1, 0.5F));
  EXPECT_NEAR(pose.values[0], 0.5F, 0.05F);
  EXPECT_NEAR(pose.values[1], 0.5F, 0.05F);
  EXPECT_NEAR(pose.values[2], 0.5F, 0.05F);

  personal.markers[0] = Named("chin");
  ASSERT_TRUE(c.personal.Configure(personal));
  EXPECT_EQ(c.Configure().error(), Errc::kUnsupported) << "a marker that the face does not hold";
}

TEST(PersonalProfile, NeitherAFrameNorANeutralNorABlendAllocates) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c;
  c.Start(0);
  const auto face = Face(0.3F, 0.6F);
  const Neutral neutral = NeutralOf(*Face(0, 0));
  test::AllocationCounter counter;
  counter.Arm();
  const bool solved = c.retargeter.SetNeutral(neutral).has_value();
  c.retargeter.SetBlend(1);
  for (int i = 0; i < 10; ++i) c.Call(face);
  counter.Disarm();
  EXPECT_TRUE(solved);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

}  // namespace
}  // namespace facewire::retarget
