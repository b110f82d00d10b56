#include "core/wire/landmark_part.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "core/wire/encoder.h"
#include "core/wire/message.h"

namespace facewire::wire {
namespace {

Landmarks Face(std::size_t count) {
  Landmarks face{.seq = (std::uint64_t{1} << 32U) + 5,
                 .captured = Time(Duration(9)),
                 .width_px = 640,
                 .height_px = 480,
                 .count = count};
  for (std::size_t i = 0; i < count; ++i) face.points_px[i].x = static_cast<float>(i);
  return face;
}

TEST(LandmarkPart, PartsTogetherAreThePictureWithNothingTwice) {
  for (const std::size_t count : {kMaxLandmarks, kMeshLandmarks, std::size_t{32}, std::size_t{1}}) {
    const Landmarks face = Face(count);
    std::vector<int> eighths;
    for (std::size_t first = 0; first < count; first += kMaxLandmarksInPart) {
      const LandmarkPart part = PartOf(face, first);
      EXPECT_EQ(part.frame_seq, 5U) << "the low half of the number";
      EXPECT_EQ(part.captured, face.captured);
      EXPECT_EQ(part.width_px, 640U);
      EXPECT_EQ(part.height_px, 480U);
      EXPECT_EQ(part.total, count);
      EXPECT_EQ(part.first, first);
      for (const LandmarkPoint& point : part.points) eighths.push_back(point.x_eighth_px);
    }
    ASSERT_EQ(eighths.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(eighths[i], 8 * static_cast<int>(i));
  }
}

TEST(LandmarkPart, APictureWithoutAFaceIsOnePartWithoutPoints) {
  const LandmarkPart part = PartOf(Face(0), 0);
  EXPECT_EQ(part.total, 0U);
  EXPECT_EQ(part.first, 0U);
  EXPECT_TRUE(part.points.empty());
  EXPECT_EQ(part.width_px, 640U);
}

TEST(LandmarkPart, BehindTheLastLandmarkThereAreNone) {
  for (const std::size_t first : {std::size_t{40}, std::size_t{41}, std::size_t{10'000}}) {
    const LandmarkPart part = PartOf(Face(40), first);
    EXPECT_TRUE(part.points.empty()) << first;
    EXPECT_TRUE(IsValid(part)) << first;
  }
}

TEST(LandmarkPart, EveryCoordinateIsTheNearestThatCanBeTold) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  struct Case {
    float px;
    int eighths;
  };
  // Rounding to the nearest, then the ends of an i16.
  for (const Case c :
       {Case{0, 0}, Case{0.0624F, 0}, Case{0.0626F, 1}, Case{-0.0626F, -1}, Case{320.5F, 2564},
        Case{4095.875F, 32767}, Case{4096, 32767}, Case{1e6F, 32767}, Case{kInfinity, 32767},
        Case{-4096, -32768}, Case{-4097, -32768}, Case{-kInfinity, -32768},
        Case{std::numeric_limits<float>::quiet_NaN(), 0}}) {
    Landmarks face = Face(1);
    face.points_px[0] = {c.px, -c.px, 0};
    const LandmarkPoint point = PartOf(face, 0).points[0];
    EXPECT_EQ(point.x_eighth_px, c.eighths) << c.px;
    const bool end = c.eighths == 32767 || c.eighths == -32768;
    EXPECT_TRUE(end || point.y_eighth_px == -c.eighths) << c.px;
  }
}

TEST(LandmarkPart, SizesOfPicturesThatCannotBeToldAreTheNearest) {
  Landmarks face = Face(1);
  face.width_px = -1;
  face.height_px = 70'000;
  EXPECT_EQ(PartOf(face, 0).width_px, 0U);
  EXPECT_EQ(PartOf(face, 0).height_px, 65535U);
}

TEST(LandmarkPart, TakesLessThan14MillisecondsOf115200Baud) {
  static_assert(kLandmarkPartFrameBytes * 10 * 1000 <= 14 * 115200);
}

TEST(LandmarkPart, WhatADecoderWouldCallMalformedIsNotSent) {
  std::array<std::byte, kLandmarkPartFrameBytes> out;
  LandmarkPart beyond = PartOf(Face(40), 32);
  beyond.total = 39;
  EXPECT_EQ(Encoder().Encode(beyond, out).error(), Errc::kInvalidArgument);
  LandmarkPart many = PartOf(Face(40), 0);
  many.total = kMaxLandmarks + 1;
  EXPECT_EQ(Encoder().Encode(many, out).error(), Errc::kInvalidArgument);
}

}  // namespace
}  // namespace facewire::wire
