#include "core/servo/servo_rig.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/core/servo/generated_servos.h"

namespace facewire::servo {
namespace {

using Part = Flaw::Part;

ServoRig LidAndEye() {
  ServoRig rig;
  (void)rig.servos.try_push(PulseServo("lid", 0));
  (void)rig.servos.try_push(PulseServo("eye", 1));
  Linkage linkage;
  linkage.name = *ShortName::From("lid_over_eye");
  linkage.yields = 0;
  linkage.other = 1;
  linkage.offset = -100;
  (void)rig.linkages.try_push(linkage);
  return rig;
}

struct Row {
  const char* what;
  Part part;
  std::size_t servo;
  std::function<void(ServoRig&)> spoil;
};

TEST(FindFlaw, FindsNoneInAGoodRig) { EXPECT_FALSE(FindFlaw(LidAndEye())); }

TEST(FindFlaw, SaysWhatIsWrongAndOfWhichServo) {
  const Row table[] = {
      {"no name", Part::kName, 1, [](ServoRig& r) { r.servos[1].name = {}; }},
      {"a second name", Part::kName, 1, [](ServoRig& r) { r.servos[1].name = r.servos[0].name; }},
      {"no bus", Part::kAddress, 0, [](ServoRig& r) { r.servos[0].bus = {}; }},
      {"a second address", Part::kAddress, 1, [](ServoRig& r) { r.servos[1].id = 0; }},
      {"no map for a source", Part::kMap, 0,
       [](ServoRig& r) {
         (void)r.servos[0].sources.try_push({*ShortName::From("x"), 1});
         r.servos[0].map.clear();
       }},
      {"a map that turns", Part::kMap, 0,
       [](ServoRig& r) {
         (void)r.servos[0].sources.try_push({*ShortName::From("x"), 1});
         (void)r.servos[0].map.try_push({2, 1500});
       }},
      {"a map that goes back", Part::kMap, 0,
       [](ServoRig& r) {
         (void)r.servos[0].sources.try_push({*ShortName::From("x"), 1});
         r.servos[0].map[1].in = 0;
       }},
      {"an offset without a number", Part::kMap, 0,
       [](ServoRig& r) {
         (void)r.servos[0].sources.try_push({*ShortName::From("x"), 1});
         r.servos[0].offset = kNan;
       }},
      {"a gain without a number", Part::kSource, 1,
       [](ServoRig& r) {
         (void)r.servos[1].sources.try_push({*ShortName::From("x"), kInfinity});
       }},
      {"min above max", Part::kRange, 0, [](ServoRig& r) { r.servos[0].min = 2001; }},
      {"neutral outside", Part::kRange, 1, [](ServoRig& r) { r.servos[1].neutral = 999; }},
      {"neutral without a number", Part::kRange, 1,
       [](ServoRig& r) { r.servos[1].neutral = kNan; }},
      {"a negative dead band", Part::kBand, 1, [](ServoRig& r) { r.servos[1].dead_band = -1; }},
      {"a backlash without a number", Part::kBand, 1,
       [](ServoRig& r) { r.servos[1].backlash = kNan; }},
      {"a dead band wider than the range", Part::kBand, 1,
       [](ServoRig& r) { r.servos[1].dead_band = 1001; }},
      {"no speed", Part::kMotion, 1, [](ServoRig& r) { r.servos[1].max_speed_per_s = 0; }},
      {"a negative acceleration", Part::kMotion, 1,
       [](ServoRig& r) { r.servos[1].max_acceleration_per_s2 = -1; }},
      {"no crawl", Part::kMotion, 1, [](ServoRig& r) { r.servos[1].crawl_speed_per_s = 0; }},
      {"a crawl above the speed", Part::kMotion, 1,
       [](ServoRig& r) { r.servos[1].crawl_speed_per_s = 4001; }},
      {"a negative idle time", Part::kMotion, 1,
       [](ServoRig& r) { r.servos[1].limp_after = -std::chrono::seconds(1); }},
      {"a rule without a servo", Part::kLinkage, 0, [](ServoRig& r) { r.linkages[0].other = 2; }},
      {"a rule with itself", Part::kLinkage, 0, [](ServoRig& r) { r.linkages[0].other = 0; }},
      {"a rule without a number", Part::kLinkage, 0,
       [](ServoRig& r) { r.linkages[0].gain = kNan; }},
      {"a rule that neutral breaks", Part::kLinkage, 0,
       [](ServoRig& r) { r.linkages[0].offset = 1; }},
      {"a negative time", Part::kContract, 0,
       [](ServoRig& r) { r.contract.ease = -std::chrono::seconds(1); }},
      {"a long lead", Part::kFollowing, 0,
       [](ServoRig& r) { r.following.lead = std::chrono::milliseconds(101); }},
      {"a calm without a number", Part::kFollowing, 0,
       [](ServoRig& r) { r.following.calm = kNan; }},
  };
  for (const Row& row : table) {
    ServoRig rig = LidAndEye();
    row.spoil(rig);
    const auto flaw = FindFlaw(rig);
    ASSERT_TRUE(flaw) << row.what;
    EXPECT_EQ(flaw->part, row.part) << row.what;
    EXPECT_EQ(flaw->servo, row.servo) << row.what;
  }
}

TEST(FindFlaw, ASourceMustBeAChannelOfTheRig) {
  Rig character;
  (void)character.channels.try_push(
      {.name = *ShortName::From("jaw.pitch"), .drives = {}, .response = {}});
  ServoRig rig = LidAndEye();
  (void)rig.servos[1].sources.try_push({*ShortName::From("jaw.pitch"), 1});
  EXPECT_FALSE(FindFlaw(rig, character));
  (void)rig.servos[1].sources.try_push({*ShortName::From("jaw.yaw"), 1});
  const auto flaw = FindFlaw(rig, character);
  ASSERT_TRUE(flaw);
  EXPECT_EQ(flaw->part, Part::kSource);
  EXPECT_EQ(flaw->servo, 1U);
  EXPECT_EQ(flaw->item, 1U);
}

TEST(ServoRig, FindsAServoByItsName) {
  const ServoRig rig = LidAndEye();
  EXPECT_EQ(rig.Find("eye"), 1U);
  EXPECT_EQ(rig.Find("nose"), std::nullopt);
}

}  // namespace
}  // namespace facewire::servo
