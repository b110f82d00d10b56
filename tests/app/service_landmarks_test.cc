#include <gtest/gtest.h>

#include <map>

#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using wire::CommandCode;
using wire::CommandResult;

// A service that sees a face of 478 landmarks, each at a place of its own.
struct Seeing : ServiceContext {
  Seeing() {
    follower.landmarks.count = kMaxLandmarks;
    for (std::size_t i = 0; i < kMaxLandmarks; ++i) {
      follower.landmarks.points_px[i] = {static_cast<float>(i), 2 * static_cast<float>(i), 9};
    }
    BringToTracking();
  }
  void Ask(float pictures_a_second) {
    SendCommand(CommandCode::kLandmarks, 7, pictures_a_second);
    Tick();
    ASSERT_FALSE(answers.empty());
    result = answers.back().result;
  }
  // Pictures of which all has come, by their number.
  std::map<std::uint32_t, std::size_t> Whole() const {
    std::map<std::uint32_t, std::size_t> points;
    for (const wire::LandmarkPart& part : parts) points[part.frame_seq] += part.points.size();
    std::erase_if(points, [](const auto& p) { return p.second != kMaxLandmarks; });
    return points;
  }
  CommandResult result = CommandResult::kFailed;
};

TEST(ServiceLandmarks, AreNotSentUnlessAHostAsks) {
  Seeing c;
  c.For(seconds(10));
  EXPECT_TRUE(c.parts.empty());
}

TEST(ServiceLandmarks, ComeWholeAtTheRateThatWasAskedForAndInStepWithThePoses) {
  Seeing c;
  c.Ask(30);
  ASSERT_EQ(c.result, CommandResult::kOk);
  c.For(seconds(2));
  c.parts.clear();
  c.poses.clear();
  c.For(seconds(2));
  const auto whole = c.Whole();
  EXPECT_NEAR(static_cast<double>(whole.size()), 60, 2);
  for (const wire::LandmarkPart& part : c.parts) {
    const auto pose = std::ranges::find(c.poses, part.frame_seq, &wire::Pose::frame_seq);
    ASSERT_NE(pose, c.poses.end());
    EXPECT_EQ(pose->captured, part.captured);
    EXPECT_EQ(part.width_px, 2U) << "of the fake's pictures";
    EXPECT_EQ(part.height_px, 2U);
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      EXPECT_EQ(part.points[i].x_eighth_px, 8 * static_cast<int>(part.first + i));
      EXPECT_EQ(part.points[i].y_eighth_px, 16 * static_cast<int>(part.first + i));
    }
  }
}

TEST(ServiceLandmarks, EndFiveSecondsAfterTheLastAsking) {
  Seeing c;
  c.Ask(10);
  c.For(seconds(4));
  c.Ask(10);
  c.For(milliseconds(4900));
  const std::size_t at_the_end = c.parts.size();
  EXPECT_NEAR(static_cast<double>(c.Whole().size()), 89, 3);
  c.For(milliseconds(200));
  const std::size_t after = c.parts.size();
  EXPECT_LE(after, at_the_end + 30);
  c.For(seconds(5));
  EXPECT_EQ(c.parts.size(), after);
}

TEST(ServiceLandmarks, EndAtOnceWhenTheHostWantsNone) {
  Seeing c;
  c.Ask(30);
  c.For(seconds(1));
  EXPECT_FALSE(c.parts.empty());
  c.Ask(0);
  EXPECT_EQ(c.result, CommandResult::kOk);
  c.parts.clear();
  c.For(seconds(1));
  EXPECT_TRUE(c.parts.empty());
}

TEST(ServiceLandmarks, SayThatAPictureShowsNoFace) {
  Seeing c;
  c.follower.failure = Errc::kNoFace;
  c.Ask(30);
  c.parts.clear();
  c.For(seconds(1));
  EXPECT_NEAR(static_cast<double>(c.parts.size()), 30, 2);
  for (const wire::LandmarkPart& part : c.parts) {
    EXPECT_EQ(part.total, 0U);
    EXPECT_EQ(part.width_px, 2U);
  }
}

TEST(ServiceLandmarks, AreForgottenWithALineThatWasLost) {
  Seeing c;
  c.Ask(30);
  c.For(seconds(1));
  c.port.Unplug();
  c.For(milliseconds(500));
  c.port.Plug();
  c.For(seconds(1));
  c.parts.clear();
  c.For(seconds(1));
  EXPECT_FALSE(c.poses.empty());
  EXPECT_TRUE(c.parts.empty()) << "perhaps another host is there now";
}

TEST(ServiceLandmarks, AreRefusedAtARateThatIsNone) {
  Seeing c;
  for (const float bad : {-1.0F, 61.0F}) {
    c.Ask(bad);
    EXPECT_EQ(c.result, CommandResult::kRefused) << bad;
  }
  c.For(seconds(1));
  EXPECT_TRUE(c.parts.empty());
}

}  // namespace
}  // namespace facewire::app
