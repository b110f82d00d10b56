#include "core/wire/ifacialmocap/ifacialmocap.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace facewire::wire::ifacialmocap {
namespace {

struct Context {
  arkit::Face face;
  bool tracking = true;
  Version version = Version::kFirst;
  std::array<std::byte, kMaxPacketBytes> out{};

  std::string Packet() {
    const auto packet = Encode(version, face, tracking, out).value();
    return {reinterpret_cast<const char*>(packet.data()), packet.size()};
  }
};

TEST(IFacialMocap, IsOneLineOfNamesAndPerCentsThenAngles) {
  Context c;
  c.face.shapes[17] = 0.42F;
  c.face.shapes[23] = 1;
  c.face.neck = {.pitch_deg = -12.5F, .yaw_deg = 3, .roll_deg = 0.0625F};
  c.face.left_eye = {.pitch_deg = 6, .yaw_deg = -1.5F};
  c.face.right_eye = {.pitch_deg = 6, .yaw_deg = 2.25F};
  EXPECT_EQ(
      c.Packet(),
      "eyeBlink_L-0|eyeLookDown_L-0|eyeLookIn_L-0|eyeLookOut_L-0|eyeLookUp_L-0|eyeSquint_L-0|"
      "eyeWide_L-0|eyeBlink_R-0|eyeLookDown_R-0|eyeLookIn_R-0|eyeLookOut_R-0|eyeLookUp_R-0|"
      "eyeSquint_R-0|eyeWide_R-0|jawForward-0|jawLeft-0|jawRight-0|jawOpen-42|mouthClose-0|"
      "mouthFunnel-0|mouthPucker-0|mouthLeft-0|mouthRight-0|mouthSmile_L-100|mouthSmile_R-0|"
      "mouthFrown_L-0|mouthFrown_R-0|mouthDimple_L-0|mouthDimple_R-0|mouthStretch_L-0|"
      "mouthStretch_R-0|mouthRollLower-0|mouthRollUpper-0|mouthShrugLower-0|mouthShrugUpper-0|"
      "mouthPress_L-0|mouthPress_R-0|mouthLowerDown_L-0|mouthLowerDown_R-0|mouthUpperUp_L-0|"
      "mouthUpperUp_R-0|browDown_L-0|browDown_R-0|browInnerUp-0|browOuterUp_L-0|browOuterUp_R-0|"
      "cheekPuff-0|cheekSquint_L-0|cheekSquint_R-0|noseSneer_L-0|noseSneer_R-0|tongueOut-0|"
      "trackingStatus-1|=head#-12.5000,3.0000,0.0625,0,0,0|rightEye#6.0000,2.2500,0.0000|"
      "leftEye#6.0000,-1.5000,0.0000|");
}

TEST(IFacialMocap, TheSecondVersionHasAnAmpersandBeforeValues) {
  Context c;
  c.version = Version::kSecond;
  EXPECT_TRUE(c.Packet().starts_with("eyeBlink_L&0|")) << c.Packet();
  EXPECT_NE(c.Packet().find("|trackingStatus&1|=head#"), std::string::npos);
}

TEST(IFacialMocap, WithoutAFaceTheStatusSaysSo) {
  Context c;
  c.tracking = false;
  EXPECT_NE(c.Packet().find("|trackingStatus-0|"), std::string::npos);
}

TEST(IFacialMocap, RoundsToTheNearestStepAndStaysInItsRange) {
  Context c;
  c.face.shapes[0] = 0.004F;
  c.face.shapes[1] = 0.996F;
  c.face.shapes[2] = 2;
  c.face.shapes[3] = -1;
  c.face.shapes[4] = std::numeric_limits<float>::quiet_NaN();
  c.face.neck = {.pitch_deg = -0.00004F,
                 .yaw_deg = std::numeric_limits<float>::infinity(),
                 .roll_deg = std::nanf("")};
  EXPECT_TRUE(c.Packet().starts_with(
      "eyeBlink_L-0|eyeLookDown_L-100|eyeLookIn_L-100|eyeLookOut_L-0|eyeLookUp_L-0|"))
      << c.Packet();
  EXPECT_NE(c.Packet().find("=head#0.0000,0.0000,0.0000,0,0,0|"), std::string::npos) << c.Packet();
}

TEST(IFacialMocap, FitsExactlyAndNotInOneByteLess) {
  Context c;
  const std::size_t size = c.Packet().size();
  EXPECT_TRUE(Encode(c.version, c.face, true, std::span(c.out).first(size)));
  EXPECT_EQ(Encode(c.version, c.face, true, std::span(c.out).first(size - 1)).error(), Errc::kFull);
}

}  // namespace
}  // namespace facewire::wire::ifacialmocap
