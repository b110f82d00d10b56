#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace facewire::tools
