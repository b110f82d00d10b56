#include "core/wire/vmc/vmc.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/core/wire/hex.h"

namespace facewire::wire::vmc {
namespace {

struct Context {
  Frame frame{.face = {}, .tracking = true, .elapsed_s = 2};

  std::vector<std::string> Packets(Names names, std::size_t room = kMaxPacketBytes) {
    std::vector<std::byte> buffer(room);
    std::vector<std::string> all;
    FramePackets packets(names, frame);
    for (;;) {
      const auto packet = packets.Next(buffer);
      if (!packet) {
        EXPECT_EQ(packet.error(), Errc::kEnd);
        return all;
      }
      all.push_back(Hex(*packet));
    }
  }
  void Set(std::string_view shape, float value) {
    frame.face.shapes[arkit::FindShape(shape).value()] = value;
  }
};

// What a text is in an OSC packet.
std::string Osc(std::string_view text) {
  std::vector<std::byte> bytes;
  for (char c : text) bytes.push_back(static_cast<std::byte>(c));
  do bytes.push_back({});
  while (bytes.size() % 4 != 0);
  return Hex(bytes);
}

TEST(Vmc, AFrameBeginsWithAvailabilityAndTime) {
  Context c;
  const auto packets = c.Packets(Names::kVrm0);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_TRUE(packets[0].starts_with(
      "23 62 75 6E 64 6C 65 00 00 00 00 00 00 00 00 01 "
      "00 00 00 24 2F 56 4D 43 2F 45 78 74 2F 4F 4B 00 2C 69 69 69 69 00 00 00 "
      "00 00 00 01 00 00 00 03 00 00 00 00 00 00 00 01 "
      "00 00 00 14 2F 56 4D 43 2F 45 78 74 2F 54 00 00 2C 66 00 00 40 00 00 00 "
      "00 00 00 44 2F 56 4D 43 2F 45 78 74 2F 42 6F 6E 65 2F 50 6F 73 00 00 00 "
      "2C 73 66 66 66 66 66 66 66 00 00 00 4E 65 63 6B 00 00 00 00 "))
      << packets[0];
  c.frame.tracking = false;
  EXPECT_EQ(c.Packets(Names::kVrm0)[0].substr(52 * 3, 11), "00 00 00 00");
}

TEST(Vmc, AShapeIsItsNameAndItsValueAndApplyEndsTheFrame) {
  Context c;
  c.Set("eyeBlinkLeft", 0.5F);
  const std::string packet = c.Packets(Names::kVrm0)[0];
  const std::string value = Osc("/VMC/Ext/Blend/Val") + " " + Osc(",sf") + " ";
  EXPECT_NE(packet.find("00 00 00 24 " + value + Osc("Blink_L") + " 3F 00 00 00"),
            std::string::npos)
      << packet;
  EXPECT_TRUE(packet.ends_with(" 00 00 00 1C " + Osc("/VMC/Ext/Blend/Apply") + " 2C 00 00 00"))
      << packet;
}

TEST(Vmc, EachSetOfNamesIsWholeAndAlone) {
  Context c;
  const auto has = [](const std::vector<std::string>& packets, std::string_view name) {
    for (const std::string& packet : packets) {
      if (packet.find(" " + Osc(name) + " ") != std::string::npos) return true;
    }
    return false;
  };
  const auto vrm0 = c.Packets(Names::kVrm0);
  const auto vrm1 = c.Packets(Names::kVrm1);
  const auto arkit = c.Packets(Names::kArkit);
  for (const char* name : {"Blink_L", "Blink_R", "A", "I", "U", "E", "O"}) {
    EXPECT_TRUE(has(vrm0, name)) << name;
    EXPECT_FALSE(has(vrm1, name)) << name;
    EXPECT_FALSE(has(arkit, name)) << name;
  }
  for (const char* name : {"blinkLeft", "blinkRight", "aa", "ih", "ou", "ee", "oh"}) {
    EXPECT_TRUE(has(vrm1, name)) << name;
    EXPECT_FALSE(has(vrm0, name)) << name;
    EXPECT_FALSE(has(arkit, name)) << name;
  }
  for (std::string_view shape : arkit::kShapeNames) {
    std::string name(shape);
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    EXPECT_TRUE(has(arkit, name)) << name;
    EXPECT_FALSE(has(vrm0, name)) << name;
  }
}

TEST(Vmc, ALongFrameIsCutBetweenMessagesAndLosesNone) {
  Context c;
  const auto whole = c.Packets(Names::kArkit);
  EXPECT_EQ(whole.size(), 3U);
  for (const std::string& packet : whole) EXPECT_LE((packet.size() + 1) / 3, kMaxPacketBytes);
  // Without the 16 bytes at the beginning of each bundle they are the same messages.
  const auto joined = [](const std::vector<std::string>& packets) {
    std::string all;
    for (const std::string& packet : packets) all += packet.substr(16 * 3 - 1);
    return all;
  };
  for (std::size_t room : {92U, 100U, 333U, 1399U}) {
    EXPECT_EQ(joined(c.Packets(Names::kArkit, room)), joined(whole)) << room;
  }
}

TEST(Vmc, SaysWhenNotEvenOneMessageFits) {
  Context c;
  std::array<std::byte, 32> small{};
  FramePackets packets(Names::kVrm0, c.frame);
  EXPECT_EQ(packets.Next(small).error(), Errc::kFull);
  EXPECT_EQ(packets.Next(std::span(small).first(8)).error(), Errc::kFull);
}

void ExpectRotation(const HeadAngles& angles, float x, float y, float z, float w) {
  const Quaternion q = UnityRotation(angles);
  EXPECT_NEAR(q.x, x, 1e-6F);
  EXPECT_NEAR(q.y, y, 1e-6F);
  EXPECT_NEAR(q.z, z, 1e-6F);
  EXPECT_NEAR(q.w, w, 1e-6F);
}

// Unity turns by the left hand: about x down, about y to the right, about z to the left ear.
TEST(Vmc, RotationsAreUnitys) {
  constexpr float kSin30 = 0.5F;
  constexpr float kCos30 = 0.8660254F;
  ExpectRotation({}, 0, 0, 0, 1);
  ExpectRotation({.pitch_deg = 60}, kSin30, 0, 0, kCos30);
  ExpectRotation({.yaw_deg = 60}, 0, -kSin30, 0, kCos30);
  ExpectRotation({.roll_deg = 60}, 0, 0, -kSin30, kCos30);
}

// Where the face's axes point after the turn, computed by Unity's own rule for its quaternions,
// must be the mirror image of where they point by the rig's angles.
TEST(Vmc, ACombinedRotationIsTheMirrorImageOfTheRigs) {
  const Quaternion q = UnityRotation({.pitch_deg = 30, .yaw_deg = 90, .roll_deg = 0});
  const auto forward = [](const Quaternion& r) {  // r * (0, 0, 1)
    return Point3{2 * (r.x * r.z + r.w * r.y), 2 * (r.y * r.z - r.w * r.x),
                  1 - 2 * (r.x * r.x + r.y * r.y)};
  };
  // Nodded by 30 degrees, then turned by a quarter to the own left, which is -x in Unity.
  EXPECT_NEAR(forward(q).x, -0.8660254F, 1e-6F);
  EXPECT_NEAR(forward(q).y, -0.5F, 1e-6F);
  EXPECT_NEAR(forward(q).z, 0, 1e-6F);
}

TEST(Vmc, VowelsComeFromTheOpeningAndTheRoundnessOfTheMouth) {
  Context c;
  const auto vowels = [&] { return VowelsOf(c.frame.face); };
  EXPECT_EQ(vowels().a, 0);
  c.Set("jawOpen", 1);
  EXPECT_EQ(vowels().a, 1);
  c.Set("mouthStretchLeft", 1);
  c.Set("mouthStretchRight", 1);
  EXPECT_EQ(vowels().e, 1);
  c.Set("jawOpen", 0);
  EXPECT_EQ(vowels().i, 1);
  c.Set("mouthPucker", 1);
  EXPECT_EQ(vowels().u, 1);
  EXPECT_EQ(vowels().i, 0);
  c.Set("jawOpen", 1);
  EXPECT_EQ(vowels().o, 1);
  // The lips are closed over an open jaw: no vowel.
  c.Set("mouthPucker", 0);
  c.Set("mouthStretchLeft", 0);
  c.Set("mouthStretchRight", 0);
  c.Set("mouthClose", 1);
  EXPECT_EQ(vowels().a, 0);
}

}  // namespace
}  // namespace facewire::wire::vmc
