// Bones under any input: whatever the performer's neutral, the character and the points of a frame
// are, what leaves the limiter is a number inside its channel's limits.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "core/limit/limiter.h"
#include "core/retarget/retargeter.h"
#include "tests/support/generated_face.h"

namespace facewire::retarget {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class SafeBones : public testing::Test {
 protected:
  // Bones of `landmarks`, which may move by -1 to 2 cm along each axis.
  void MakeRig(std::size_t bones) {
    rig_ = std::make_unique<Rig>();
    for (std::size_t b = 0; b < bones; ++b) {
      Bone bone;
      bone.landmark = static_cast<std::int16_t>((7 * b + 1) % kMaxLandmarks);
      bone.rest_cm = face_[bone.landmark];
      ASSERT_TRUE(rig_->bones.try_push(bone));
      for (const auto kind :
           {ChannelKind::kPositionX, ChannelKind::kPositionY, ChannelKind::kPositionZ}) {
        Channel channel;
        channel.kind = kind;
        channel.bone = static_cast<std::int16_t>(b);
        channel.min = -1;
        channel.max = 2;
        ASSERT_TRUE(rig_->channels.try_push(channel));
      }
    }
  }
  Result<> Start() {
    Arena arena(block_);
    if (auto r = retargeter_->Configure(*rig_, nullptr, arena); !r) return r;
    if (auto r = limiter_->Configure(*rig_); !r) return r;
    limiter_->Reset(rig_->NeutralPose());
    return retargeter_->SetNeutral(neutral_);
  }
  // A frame, and the check that this test is for.
  void ExpectSafe(const FacePose& face) {
    const RigPose wish = retargeter_->Update(face);
    for (std::size_t i = 0; i < wish.count; ++i) ASSERT_TRUE(std::isfinite(wish.values[i]));
    now_ += Duration(10'000);
    const RigPose pose = limiter_->Update(wish, now_);
    ASSERT_EQ(pose.count, rig_->channels.size());
    for (std::size_t i = 0; i < pose.count; ++i) {
      ASSERT_GE(pose.values[i], rig_->channels[i].min);
      ASSERT_LE(pose.values[i], rig_->channels[i].max);
    }
  }
  // Points near the face, points anywhere, and numbers of any kind.
  float AnyNumber() {
    switch (random_() % 6) {
      case 0:
      case 1:
        return std::uniform_real_distribution<float>(-12, 12)(random_);
      case 2:
        return std::uniform_real_distribution<float>(-1e6F, 1e6F)(random_);
      case 3:
        return 0;
      default: {  // any bits: infinities, denormals, NaN
        const auto bits = static_cast<std::uint32_t>(random_());
        float number = 0;
        std::memcpy(&number, &bits, sizeof number);
        return number;
      }
    }
  }
  Point3 AnyPoint() { return {AnyNumber(), AnyNumber(), AnyNumber()}; }
  void ExpectSafeWithAnyFrame(int frames) {
    auto face = std::make_unique<FacePose>();
    face->points_cm = face_;
    face->count = kMaxLandmarks;
    ExpectSafe(*face);
    for (int i = 0; i < frames; ++i) {
      for (Point3& p : face->points_cm) p = AnyPoint();
      face->count = i % 5 == 0 ? random_() % (kMaxLandmarks + 1) : kMaxLandmarks;
      ExpectSafe(*face);
    }
  }

  std::mt19937 random_{20121};
  const test::FacePoints face_ = test::GeneratedFace();
  Neutral neutral_{.count = kMaxLandmarks, .points_cm = face_};
  std::unique_ptr<Rig> rig_;
  std::vector<std::byte> block_ = std::vector<std::byte>(Retargeter::RequiredBytes());
  std::unique_ptr<Retargeter> retargeter_ = std::make_unique<Retargeter>();
  std::unique_ptr<limit::Limiter> limiter_ = std::make_unique<limit::Limiter>();
  Time now_{};
};

TEST_F(SafeBones, StayInsideTheirLimitsForAnyNumberOfBonesAndAnyFrame) {
  for (const std::size_t bones : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3},
                                  std::size_t{4}, std::size_t{20}, kMaxBones}) {
    SCOPED_TRACE(bones);
    ASSERT_NO_FATAL_FAILURE(MakeRig(bones));
    ASSERT_TRUE(Start());
    ASSERT_NO_FATAL_FAILURE(ExpectSafeWithAnyFrame(200));
  }
}

TEST_F(SafeBones, StayInsideTheirLimitsForCharactersOfAnyShape) {
  using Shape = Point3 (*)(Point3);
  constexpr std::array<Shape, 6> kShapes = {
      [](Point3) { return Point3{}; },  // all in one place
      [](Point3 p) {
        return Point3{p.x, p.y, 0};
      },  // flat
      [](Point3 p) {
        return Point3{0, p.y, 0};
      },  // on a line
      [](Point3 p) {
        return Point3{-p.x, p.y, p.z};
      },                                     // mirrored
      [](Point3 p) { return 1000.0F * p; },  // a giant
      [](Point3 p) {
        return Point3{p.x, std::fmod(9 * p.y, 1.0F), 0};
      }  // torn
  };
  for (const Shape shape : kShapes) {
    ASSERT_NO_FATAL_FAILURE(MakeRig(20));
    for (Bone& bone : rig_->bones) bone.rest_cm = shape(bone.rest_cm);
    ASSERT_TRUE(Start());
    ASSERT_NO_FATAL_FAILURE(ExpectSafeWithAnyFrame(100));
  }
}

TEST_F(SafeBones, StayInsideTheirLimitsForAnyNeutralThatIsTaken) {
  ASSERT_NO_FATAL_FAILURE(MakeRig(20));
  ASSERT_TRUE(Start());
  int taken = 0;
  for (int i = 0; i < 60; ++i) {
    neutral_.points_cm = face_;
    // Flat, on a line, nearly in one place, or with a few points anywhere.
    const int kind = i % 4;
    for (Point3& p : neutral_.points_cm) {
      if (kind == 0) p.z = 0;
      if (kind == 1) p = {0, p.y, 0};
      if (kind == 2) p = 1e-3F * p;
      if (kind == 3 && random_() % 10 == 0) p = AnyPoint();
    }
    if (retargeter_->SetNeutral(neutral_)) ++taken;
    ASSERT_NO_FATAL_FAILURE(ExpectSafeWithAnyFrame(20)) << "neutral " << i;
  }
  EXPECT_GE(taken, 40);
}

TEST_F(SafeBones, ANeutralWithItsPointsInOnePlaceIsSingularAndOneOfNoNumbersIsRefused) {
  ASSERT_NO_FATAL_FAILURE(MakeRig(20));
  ASSERT_TRUE(Start());
  neutral_.points_cm.fill({1, 2, 3});
  EXPECT_EQ(retargeter_->SetNeutral(neutral_).error(), Errc::kSingular);
  neutral_.points_cm[3].y = kNan;
  EXPECT_EQ(retargeter_->SetNeutral(neutral_).error(), Errc::kInvalidArgument);
  ASSERT_NO_FATAL_FAILURE(ExpectSafeWithAnyFrame(10)) << "with the neutral before";
}

TEST_F(SafeBones, APointThatIsNoNumberLeavesItsOwnBoneAtRestAndNoOther) {
  ASSERT_NO_FATAL_FAILURE(MakeRig(20));
  ASSERT_TRUE(Start());
  FacePose face;
  face.count = kMaxLandmarks;
  face.points_cm = face_;
  for (Point3& p : face.points_cm) p.y -= 0.5F;
  face.points_cm[rig_->bones[4].landmark].x = kNan;
  const RigPose pose = retargeter_->Update(face);
  for (std::size_t b = 0; b < 20; ++b)
    EXPECT_NEAR(pose.values[3 * b + 1], b == 4 ? 0 : -0.5F, 0.02F) << "bone " << b;
}

}  // namespace
}  // namespace facewire::retarget
