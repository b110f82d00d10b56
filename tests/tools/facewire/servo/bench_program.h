#ifndef FACEWIRE_TESTS_TOOLS_FACEWIRE_SERVO_BENCH_PROGRAM_H_
#define FACEWIRE_TESTS_TOOLS_FACEWIRE_SERVO_BENCH_PROGRAM_H_

#include <gtest/gtest.h>

#include <chrono>
#include <list>
#include <string>
#include <thread>
#include <vector>

#include "tests/app/process.h"
#include "tests/app/scratch.h"
#include "tests/tools/facewire/run.h"

namespace facewire::tools {

// Simulated buses on pseudo-terminals, and facewire to be run against them, in a scratch folder.
class ServoBench : public testing::Test {
 protected:
  // A bus with the link `name`; returns when it is there.
  void StartBus(const std::string& name, std::vector<std::string> options) {
    options.insert(options.begin(), SIM_BUS);
    options.insert(options.end(), {"--link", Path(name)});
    const app::Process& bus =
        buses_.emplace_back(options, Path(name + ".out"), Path(name + ".err"));
    for (int i = 0; i < 10'000 && bus.out().find('\n') == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(bus.out().starts_with("sim_bus: ")) << bus.err();
  }
  // What it counted, after its end.
  std::string EndBus(std::size_t index = 0) {
    auto bus = std::next(buses_.begin(), static_cast<std::ptrdiff_t>(index));
    bus->Signal(SIGTERM);
    EXPECT_EQ(bus->Wait(), 0);
    return bus->out();
  }
  Outcome Servo(std::vector<std::string> arguments, const std::string& input = {}) {
    arguments.insert(arguments.begin(), {FACEWIRE_TOOL, "servo"});
    scratch_.Write("in", input);
    std::vector<std::string> shell = {"/bin/sh", "-c", "exec \"$@\" <" + Path("in"), "sh"};
    shell.insert(shell.end(), arguments.begin(), arguments.end());
    app::Process program(shell, Path("out"), Path("err"));
    Outcome outcome;
    outcome.code = program.Wait();
    outcome.out = program.out();
    outcome.err = program.err();
    return outcome;
  }
  std::string Path(const std::string& name) const { return (scratch_.folder() / name).string(); }
  std::string Write(const char* name, const std::string& text) const {
    return scratch_.Write(name, text).string();
  }
  std::string Read(const std::string& name) const { return app::Scratch::Read(Path(name)); }

  app::Scratch scratch_;
  std::list<app::Process> buses_;
};

// A configuration with a chain of Feetech servos at the link "sts".
inline std::string FeetechConfig(const std::string& folder) {
  return "[character]\nrig = \"rig.toml\"\nprofile = \"\"\n"
         "[[bus]]\nname = \"face\"\nkind = \"feetech\"\nport = \"serial:" +
         folder + "/sts\"\n";
}

inline constexpr const char* kJawRig = R"(name = "head"
[[parameter]]
name = "jawOpen"
drive = { jawOpen = 1 }

[[servo]]            # the jaw
name = "jaw"
bus = "face"
id = 1
from = { jawOpen = 1 }
map = [[0, 1900], [1, 2300]]   # down is open
neutral = 2000
max_speed = 4000
crawl_speed = 1000   # a second
)";

}  // namespace facewire::tools

#endif  // FACEWIRE_TESTS_TOOLS_FACEWIRE_SERVO_BENCH_PROGRAM_H_
