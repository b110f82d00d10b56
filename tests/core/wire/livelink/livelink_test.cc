#include "core/wire/livelink/livelink.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <string>
#include <vector>

#include "tests/core/wire/hex.h"

namespace facewire::wire::livelink {
namespace {

struct Context {
  Subject subject{.device_id = "ID", .name = "otto"};
  std::array<std::byte, kMaxPacketBytes> out{};

  std::string Packet(const arkit::Face* face, std::int64_t captured_us = 0) {
    return Hex(Encode(subject, Time(Duration(captured_us)), face, out).value());
  }
};

constexpr const char* kHeader =
    "06 00 00 00 02 49 44 00 00 00 04 6F 74 74 6F 00 00 00 00 00 00 00 00 00 00 00 3C 00 00 00 01";

TEST(LiveLink, WithoutAFaceThereIsOnlyTheHeader) {
  Context c;
  EXPECT_EQ(c.Packet(nullptr), kHeader);
}

TEST(LiveLink, AFaceIsItsShapesThenYawPitchRollOfHeadAndEyes) {
  Context c;
  arkit::Face face;
  face.shapes[0] = 1;
  face.shapes[51] = 0.5F;
  face.neck = {.pitch_deg = 14.323945F, .yaw_deg = 28.64789F, .roll_deg = 7.1619725F};
  face.left_eye = {.pitch_deg = -14.323945F, .yaw_deg = -28.64789F, .roll_deg = 0};
  face.right_eye = {.pitch_deg = 28.64789F, .yaw_deg = 14.323945F, .roll_deg = -7.1619725F};
  std::string expected = std::string(kHeader) + " 3D 3F 80 00 00";
  for (int i = 1; i < 51; ++i) expected += " 00 00 00 00";
  expected +=
      " 3F 00 00 00"
      " BF 00 00 00 3E 80 00 00 BE 00 00 00"   // head: -1/2, 1/4, -1/8 radians
      " 3F 00 00 00 BE 80 00 00 80 00 00 00"   // left eye: 1/2, -1/4, -0
      " BE 80 00 00 3F 00 00 00 3E 00 00 00";  // right eye: -1/4, 1/2, 1/8
  EXPECT_EQ(c.Packet(&face), expected);
}

// What the app itself sends when an eye looks as far as it can, by a recording (README.md).
TEST(LiveLink, TurnsAreRadiansPositiveToTheOwnRightAndDown) {
  Context c;
  arkit::Face face;
  face.left_eye = {.pitch_deg = 22.3F, .yaw_deg = -34.8F};  // down, and to the own right
  const std::vector<std::byte> packet = FromHex(c.Packet(&face));
  const auto value = [&](std::size_t from_end) {
    std::uint32_t word = 0;
    for (const std::byte b : std::span(packet).last(4 * from_end).first(4)) {
      word = word << 8U | std::to_integer<std::uint32_t>(b);
    }
    return std::bit_cast<float>(word);
  };
  EXPECT_NEAR(value(6), 0.607F, 0.001F);  // LeftEyeYaw
  EXPECT_NEAR(value(5), 0.389F, 0.001F);  // LeftEyePitch
}

TEST(LiveLink, TimeIsFramesOfASixtiethAndAPartOfOne) {
  Context c;
  // 1.025 s are 61.5 frames.
  EXPECT_EQ(c.Packet(nullptr, 1'025'000).substr(45, 23), "00 00 00 3D 3F 00 00 00");
  // It starts again after a day, and a clock may begin before its origin.
  EXPECT_EQ(c.Packet(nullptr, 86'400'000'000 + 1'025'000).substr(45, 23),
            "00 00 00 3D 3F 00 00 00");
  EXPECT_EQ(c.Packet(nullptr, -500'000).substr(45, 23), "00 4F 19 E2 00 00 00 00");
}

TEST(LiveLink, RefusesANameThatTheFormatHasNoRoomFor) {
  Context c;
  c.subject.name = "";
  EXPECT_EQ(Encode(c.subject, Time{}, nullptr, c.out).error(), Errc::kOutOfRange);
  const std::string longest(kMaxTextBytes, 'x');
  c.subject = {.device_id = longest, .name = longest};
  const arkit::Face face;
  EXPECT_EQ(Encode(c.subject, Time{}, &face, c.out)->size(), kMaxPacketBytes);
  const std::string longer = longest + "x";
  c.subject.device_id = longer;
  EXPECT_EQ(Encode(c.subject, Time{}, &face, c.out).error(), Errc::kOutOfRange);
}

TEST(LiveLink, FitsExactlyAndNotInOneByteLess) {
  Context c;
  const arkit::Face face;
  const std::size_t size = Encode(c.subject, Time{}, &face, c.out)->size();
  EXPECT_TRUE(Encode(c.subject, Time{}, &face, std::span(c.out).first(size)));
  EXPECT_EQ(Encode(c.subject, Time{}, &face, std::span(c.out).first(size - 1)).error(),
            Errc::kFull);
}

}  // namespace
}  // namespace facewire::wire::livelink
