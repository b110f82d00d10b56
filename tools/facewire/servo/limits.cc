// facewire servo limits: a servo's limits by example.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/servo/ask.h"
#include "tools/facewire/servo/jog.h"
#include "tools/facewire/servo/open.h"
#include "tools/facewire/servo/rig_text.h"
#include "tools/facewire/servo/verbs.h"
#include "tools/facewire/stop_flag.h"

namespace facewire::tools {
namespace {

struct LimitsOptions {
  std::string servo;
  std::string config = kUsualConfig;
  std::string map = "ask";
};

constexpr std::chrono::seconds kLongestSearch(4);

std::string ReadFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool MovesMap(const LimitsOptions& options, const servo::Servo& servo) {
  if (servo.map.empty() || options.map == "keep") return false;
  return options.map == "move" ||
         AskYes("Shall the ends of its map be these, too, so that the rig's whole range uses them?",
                true);
}

void Limits(const LimitsOptions& options) {
  const Installation all = LoadInstallation(options.config);
  const servo::Servo& servo = all.servos.servos[FindServo(all, options.servo)];
  const app::ServoBusConfig& bus = FindBus(all, servo.bus.view());
  RequireWritable(all.rig_file);
  Marks marks;
  {
    hal::SystemClock clock;
    Mover mover(Alone(bus, servo), 0, clock);
    const StopFlag stop;
    mover.Open(kLongestSearch);
    Jog jog(mover, {.marks = true,
                    .title = "facewire servo limits " + options.servo + ": now " +
                             PositionText(servo.min) + " to " + PositionText(servo.max) +
                             ", neutral " + PositionText(servo.neutral)});
    RunJog(jog, mover, [&] { return stop.Raised(); });
    if (!jog.confirmed()) {
      throw app::Failure("given up; " + all.rig_file.string() + " is as it was");
    }
    marks = jog.marks();
  }
  const auto [low, high] = std::minmax(*marks.first, *marks.second);
  const ServoEdit edit{.min = low,
                       .max = high,
                       .neutral = *marks.neutral,
                       .map_ends = MovesMap(options, servo),
                       .neutral_was = servo.neutral};
  ReplaceRig(all.rig_file, EditServo(ReadFile(all.rig_file), options.servo, edit));
  std::printf("%s: min %s -> %s, max %s -> %s, neutral %s -> %s%s, in %s\n", options.servo.c_str(),
              PositionText(servo.min).c_str(), PositionText(low).c_str(),
              PositionText(servo.max).c_str(), PositionText(high).c_str(),
              PositionText(servo.neutral).c_str(), PositionText(*marks.neutral).c_str(),
              edit.map_ends ? ", map likewise" : "", all.rig_file.c_str());
}

}  // namespace

void AddServoLimits(CLI::App& servo) {
  auto options = std::make_shared<LimitsOptions>();
  CLI::App* command =
      servo.add_subcommand("limits", "Set one servo's limits by going there, in the rig file");
  command->add_option("NAME", options->servo, "The servo's name in the rig")->required();
  AddConfigOption(*command, options->config);
  command
      ->add_option("--map", options->map,
                   "Whether the ends of its map become the limits, too: move, keep, or ask")
      ->check(CLI::IsMember({"move", "keep", "ask"}))
      ->capture_default_str();
  command->footer(
      "Go to one end with the arrow keys and press 1, to the other and press 2, to neutral and "
      "press 3; Enter writes\n"
      "min, max and neutral into the rig file, where nothing else changes. A servo that tells "
      "where it is can be made limp\n"
      "(space) and moved by hand instead. It is alone on its way, never faster than its crawl, and "
      "no limit of the rig\n"
      "holds: mind the linkage. The rig is checked before it replaces the old one; there is no "
      "backup, and the\n"
      "old numbers are printed.\n"
      "From a script: words on the standard input as for jog, then y or n for the map.");
  command->callback([options] { Limits(*options); });
}

}  // namespace facewire::tools
