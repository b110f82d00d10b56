#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(FacewireDoctor, SaysWhatIsMissingAndWhatFixesIt) {
  const Outcome outcome = RunFacewire({"doctor", "--networks", "/nowhere"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("FAIL  networks"));
  EXPECT_THAT(outcome.out, HasSubstr("-> tools/setup"));
  EXPECT_THAT(outcome.out, HasSubstr("clock"));
}

TEST(FacewireDoctor, ReadsTheConfigurationThatItIsGiven) {
  const Scratch scratch;
  const std::string config = scratch.Write("f.toml", "[camera]\nwidth = 3\n");
  const Outcome outcome = RunFacewire(
      {"doctor", "--config", config, "--networks", FACEWIRE_ASSETS "/networks", "--json"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("{\"check\":\"networks\",\"verdict\":\"OK\""));
  EXPECT_THAT(outcome.out, HasSubstr("{\"check\":\"configuration\",\"verdict\":\"FAIL\""));
}

TEST(FacewireDoctor, LooksAtThePortsOfServoBuses) {
  const Scratch scratch;
  const std::string config = scratch.Write(
      "f.toml", "[character]\nrig = \"" FACEWIRE_SOURCE_DIR
                "/app/share/otto.toml\"\n[[bus]]\nname = \"face\"\nkind = \"maestro\"\nport = "
                "\"serial:/dev/no-such-port\"\n");
  const Outcome outcome = RunFacewire({"doctor", "--config", config});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("FAIL  bus face       there is no port /dev/no-such-port\n"));
  EXPECT_THAT(outcome.out, HasSubstr("FAIL  servos         bus \"face\": no servo of the rig is on "
                                     "it"));
}

// Whatever cameras this machine has: a list and success, or one line that says why not.
TEST(FacewireDoctor, ListsTheCamerasAndNothingElse) {
  for (const bool json : {false, true}) {
    std::vector<std::string> arguments = {"doctor", "--cameras"};
    if (json) arguments.emplace_back("--json");
    const Outcome outcome = RunFacewire(arguments);
    EXPECT_THAT(outcome.out, Not(HasSubstr("networks")));
    if (outcome.code == 0) {
      EXPECT_THAT(outcome.out, HasSubstr(json ? "{\"address\":" : "  device = \""));
    } else {
      EXPECT_EQ(outcome.code, 1);
      EXPECT_THAT(outcome.err, HasSubstr("camera"));
    }
  }
}

}  // namespace
}  // namespace facewire::tools
