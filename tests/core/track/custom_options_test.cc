#include "core/track/custom_options.h"

#include <flatbuffers/flexbuffers.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

namespace facewire::track {
namespace {

// Options of the real kind; a test changes some of them.
struct Written {
  std::vector<std::int32_t> subset = {33, 7, 163, 467};
  std::int64_t left = 33;
  std::int64_t right = 133;
  std::int64_t width = 16;
  std::int64_t height = 12;
  float scale = 1.5F;

  std::vector<std::uint8_t> Bytes() const {
    flexbuffers::Builder builder;
    builder.Map([&] {
      builder.TypedVector("subset_idxs", [&] {
        for (const std::int32_t i : subset) builder.Int(i);
      });
      builder.Int("left_rotation_idx", left);
      builder.Int("right_rotation_idx", right);
      builder.Int("output_width", width);
      builder.Int("output_height", height);
      builder.Float("scale_x", scale);
      builder.Float("scale_y", scale);
    });
    builder.Finish();
    return builder.GetBuffer();
  }
};

Result<PartOptions> Read(const std::vector<std::uint8_t>& bytes) {
  return ReadPartOptions(std::as_bytes(std::span(bytes)));
}

TEST(PartOptionsTest, AreReadAsWritten) {
  const auto options = Read(Written{}.Bytes());
  ASSERT_TRUE(options);
  ASSERT_EQ(options->subset.size(), 4U);
  EXPECT_EQ(options->subset[3], 467);
  EXPECT_EQ(options->left_rotation, 33);
  EXPECT_EQ(options->right_rotation, 133);
  EXPECT_EQ(options->output_width, 16);
  EXPECT_EQ(options->output_height, 12);
  EXPECT_EQ(options->scale_x, 1.5F);
}

TEST(PartOptionsTest, ValuesOutOfRangeAreRefused) {
  const std::vector<std::function<void(Written&)>> changes = {
      [](Written& w) { w.subset.clear(); },
      [](Written& w) { w.subset[1] = 468; },
      [](Written& w) { w.subset[1] = -1; },
      [](Written& w) { w.subset.assign(kMaxSubset + 1, 5); },
      [](Written& w) { w.left = 468; },
      [](Written& w) { w.right = -1; },
      [](Written& w) { w.width = 0; },
      [](Written& w) { w.height = 1 << 20; },
      [](Written& w) { w.scale = 0; },
      [](Written& w) { w.scale = std::numeric_limits<float>::quiet_NaN(); },
      [](Written& w) { w.scale = 1e9F; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Written written;
    changes[i](written);
    EXPECT_EQ(Read(written.Bytes()).error(), Errc::kCorrupt) << i;
  }
}

TEST(PartOptionsTest, AFullSubsetFits) {
  Written written;
  written.subset.assign(kMaxSubset, 5);
  EXPECT_TRUE(Read(written.Bytes()));
}

TEST(PartOptionsTest, SomethingElseIsRefused) {
  flexbuffers::Builder builder;
  builder.Add("just text");
  builder.Finish();
  EXPECT_EQ(Read(builder.GetBuffer()).error(), Errc::kCorrupt);
  EXPECT_EQ(Read({}).error(), Errc::kCorrupt);
  EXPECT_EQ(Read(std::vector<std::uint8_t>(5000, 1)).error(), Errc::kCorrupt);
}

TEST(PartOptionsTest, DamageAnywhereIsEitherSeenOrHarmless) {
  const auto good = Written{}.Bytes();
  std::mt19937 random(1);
  for (int round = 0; round < 20000; ++round) {
    auto bytes = good;
    for (int i = 0; i < 1 + round % 4; ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (round % 5 == 0) bytes.resize(random() % bytes.size());
    const auto options = Read(bytes);  // the sanitizers watch
    EXPECT_TRUE(options || options.error() == Errc::kCorrupt);
  }
}

}  // namespace
}  // namespace facewire::track
