// From a character's file to a service that moves it: what `facewire rig import` writes, read by
// the real facewired, which follows footage with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/wire/pose.h"
#include "tests/app/facewired.h"
#include "tests/tools/facewire/rig/made_character.h"

namespace facewire::tools::rig {
namespace {

using app::Facewired;
using app::Listener;
using app::Process;
using testing::AllOf;
using testing::HasSubstr;

struct Convention {
  const char* name;
  MadeCharacter (*make)();
  const char* file;
  const char* rig_name;
  std::vector<const char*> gaps;  // what the summary names as lacking, and the file
  const char* remark;             // what the file says of the rest
  const char* jaw;                // the channels that show a mouth and a blink
  const char* blink;
};

std::ostream& operator<<(std::ostream& out, const Convention& convention) {
  return out << convention.name;
}

// A service on the mock hardware whose rig comes from a character.
struct Context {
  Facewired service{app::Configuration("", "rig.toml")};
  std::string rig = (service.scratch / "rig.toml").string();

  std::string Import(const std::string& character) {
    Process import = app::Tool(service, {"rig", "import", character, "--out", rig});
    EXPECT_EQ(import.Wait(), 0) << import.err();
    return import.out();
  }
  std::string Check() {
    Process check = service.Start({"--check"});
    EXPECT_EQ(check.Wait(), 0) << check.err();
    EXPECT_EQ(check.err(), "");
    return check.out();
  }
  // Plays the footage until each of these channels has gone through a part of its range.
  void ExpectMotion(const std::vector<std::string>& channels, double part) {
    Process process = service.Start({"--fake"});
    Listener host(service.scratch / "line");
    for (const std::string& channel : channels) {
      EXPECT_TRUE(host.Until([&] { return MotionOf(host, channel) > part; }))
          << channel << " moved " << MotionOf(host, channel) << " of its range in "
          << host.poses.size() << " poses\n"
          << process.err();
    }
    process.Signal(SIGTERM);
    EXPECT_EQ(process.Wait(), 0) << process.err();
  }

 private:
  static double MotionOf(const Listener& host, const std::string& channel) {
    if (!host.rig.Complete()) return 0;
    const auto index = host.rig.rig().FindChannel(channel);
    if (!index) return -1;
    std::uint16_t least = 0xFFFF;
    std::uint16_t most = 0;
    for (const wire::Pose& pose : host.poses) {
      if (pose.state != ServiceState::kTracking || pose.values.size() <= *index) continue;
      least = std::min(least, pose.values[*index]);
      most = std::max(most, pose.values[*index]);
    }
    return most > least ? (most - least) / 65535.0 : 0;
  }
};

class RigService : public testing::TestWithParam<Convention> {};

TEST_P(RigService, AcceptsAnImportedRigAndMovesIt) {
  const Convention& convention = GetParam();
  Context context;
  const std::string summary =
      context.Import(context.service.scratch.Write(convention.file, convention.make().Glb()));
  const std::string written = app::ReadAll(context.rig);
  for (const char* gap : convention.gaps) {
    EXPECT_THAT(summary, HasSubstr(gap));
    EXPECT_THAT(written, HasSubstr(gap));
  }
  EXPECT_THAT(written, HasSubstr(convention.remark));
  EXPECT_THAT(context.Check(), HasSubstr("rig      " + std::string(convention.rig_name) + ": "));
  context.ExpectMotion({convention.jaw, convention.blink}, 0.05);
}

TEST_P(RigService, ItsRigIsCheckedAndDrawn) {
  const Convention& convention = GetParam();
  Context context;
  (void)context.Import(context.service.scratch.Write(convention.file, convention.make().Glb()));
  Process check = app::Tool(context.service, {"rig", "check", context.rig});
  EXPECT_EQ(check.Wait(), 0) << check.err();
  EXPECT_THAT(check.out(), AllOf(testing::StartsWith(std::string(convention.rig_name) + ": "),
                                 HasSubstr(" channels, 0 servos")));
  const std::string picture = (context.service.scratch / "rig.png").string();
  Process show = app::Tool(context.service, {"rig", "show", context.rig, "--out", picture});
  EXPECT_EQ(show.Wait(), 0) << show.err();
  EXPECT_THAT(app::ReadAll(picture), testing::StartsWith("\x89PNG"));
}

INSTANTIATE_TEST_SUITE_P(Conventions, RigService,
                         testing::Values(Convention{.name = "Arkit",
                                                    .make = ArkitCharacter,
                                                    .file = "head.glb",
                                                    .rig_name = "head",
                                                    .gaps = {"tongueOut"},
                                                    .remark = "LeftHand",
                                                    .jaw = "jawOpen",
                                                    .blink = "eyeBlinkLeft"},
                                         Convention{.name = "Vrm0",
                                                    .make = Vrm0Character,
                                                    .file = "old.vrm",
                                                    .rig_name = "Old_Puppet",
                                                    .gaps = {"browInnerUp", "noseSneerLeft"},
                                                    .remark = "faces -z there",
                                                    .jaw = "A",
                                                    .blink = "Close_L"},
                                         Convention{.name = "Vrm1",
                                                    .make = Vrm1Character,
                                                    .file = "new.vrm",
                                                    .rig_name = "New_Puppet",
                                                    .gaps = {"browInnerUp", "noseSneerLeft"},
                                                    .remark = "LeftHand",
                                                    .jaw = "m1",
                                                    .blink = "m0"},
                                         Convention{.name = "PlainBones",
                                                    .make = BonesCharacter,
                                                    .file = "bones.glb",
                                                    .rig_name = "bones",
                                                    .gaps = {},
                                                    .remark = "It has no blend shape",
                                                    .jaw = "Jaw.pitch",
                                                    .blink = "eyelid_upper_L.pitch"}),
                         [](const auto& test) { return std::string(test.param.name); });

// A character that others made, which cannot be committed.
TEST(RigServiceWithAPublicCharacter, FindsAllThatItHas) {
  const char* const character = std::getenv("FACEWIRE_ICT_HEAD");
  if (character == nullptr) GTEST_SKIP() << "FACEWIRE_ICT_HEAD names no ict_head_arkit51.glb";
  Context context;
  EXPECT_THAT(context.Import(character),
              AllOf(HasSubstr("51 of 52 shown"), HasSubstr("lacks: tongueOut")));
  EXPECT_THAT(context.Check(), HasSubstr("ict_head_arkit51: "));
  context.ExpectMotion({"jawOpen", "eyeBlinkLeft"}, 0.05);
}

}  // namespace
}  // namespace facewire::tools::rig
