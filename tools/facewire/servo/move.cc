// facewire servo jog, move: one servo by hand.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/servo/jog.h"
#include "tools/facewire/servo/live.h"
#include "tools/facewire/servo/open.h"
#include "tools/facewire/servo/rig_text.h"
#include "tools/facewire/servo/verbs.h"
#include "tools/facewire/stop_flag.h"

namespace facewire::tools {
namespace {

struct MoveOptions {
  std::string servo;
  std::string config = kUsualConfig;
  double position = 0;
  double seconds = 1;
  bool live = false;
};

// From nothing to a servo that is ready, with all its settings read.
constexpr std::chrono::seconds kLongestSearch(4);

std::unique_ptr<Mover> OpenServo(const MoveOptions& options, hal::Clock& clock) {
  const Installation all = LoadInstallation(options.config);
  const Installation part = PartOf(all, FindServo(all, options.servo));
  auto mover = std::make_unique<Mover>(part, FindServo(part, options.servo), clock);
  return mover;
}

void JogServo(const MoveOptions& options) {
  hal::SystemClock clock;
  const auto mover = OpenServo(options, clock);
  const StopFlag stop;
  mover->Open(kLongestSearch);
  Jog jog(*mover, {.marks = false, .title = "facewire servo jog " + options.servo});
  RunJog(jog, *mover, [&] { return stop.Raised(); });
}

void CheckLimits(const servo::Servo& servo, const MoveOptions& options) {
  if (options.position >= servo.min && options.position <= servo.max) return;
  throw app::BadInput(PositionText(options.position) + " is outside the limits of \"" +
                      options.servo + "\", " + PositionText(servo.min) + " to " +
                      PositionText(servo.max));
}

void MoveLive(const MoveOptions& options) {
  const Installation all = LoadInstallation(options.config);
  const std::size_t servo = FindServo(all, options.servo);
  CheckLimits(all.servos.servos[servo], options);
  hal::SystemClock clock;
  const StopFlag stop;
  HoldLive(all, servo, static_cast<float>(options.position),
           Duration(static_cast<std::int64_t>(1e6 * options.seconds)), clock,
           [&] { return stop.Raised(); });
  std::printf("%s: was held at %s %s; the performer has it again\n", options.servo.c_str(),
              PositionText(options.position).c_str(),
              UnitOf(FindBus(all, all.servos.servos[servo].bus.view())));
}

void Move(const MoveOptions& options) {
  if (options.live) {
    MoveLive(options);
    return;
  }
  hal::SystemClock clock;
  const auto mover = OpenServo(options, clock);
  const servo::Servo& servo = mover->servo();
  CheckLimits(servo, options);
  const auto to = static_cast<float>(options.position);
  const StopFlag stop;
  mover->Open(kLongestSearch);
  // A crawl there, and twice as long for what may come between.
  const double slowest_s = (servo.max - servo.min) / servo.crawl_speed_per_s;
  const Time end =
      clock.Now() + std::chrono::seconds(5) + Duration(static_cast<std::int64_t>(2e6 * slowest_s));
  mover->GoTo(to);
  while (!mover->arrived() && clock.Now() < end && !stop.Raised()) mover->Tick();
  if (!mover->arrived()) {
    const std::string why = mover->trouble();
    throw app::Failure("\"" + options.servo + "\" did not get there" +
                       (why.empty() ? std::string() : ": " + why));
  }
  const Time until = clock.Now() + Duration(static_cast<std::int64_t>(1e6 * options.seconds));
  while (clock.Now() < until && !stop.Raised()) mover->Tick();
  std::printf("%s: told %s", options.servo.c_str(),
              PositionText(mover->command().position).c_str());
  if (mover->reads_back()) std::printf(", is at %s", PositionText(mover->position()).c_str());
  std::printf(" %s\n", UnitOf(mover->bus()));
}

}  // namespace

void AddServoJog(CLI::App& servo) {
  auto options = std::make_shared<MoveOptions>();
  CLI::App* command = servo.add_subcommand("jog", "Move one servo with the arrow keys");
  command->add_option("NAME", options->servo, "The servo's name in the rig")->required();
  AddConfigOption(*command, options->config);
  command->footer(
      "left, right: a small step; down, up: a large one; n: neutral; space: limp at once; q: end. "
      "The first way is a\n"
      "crawl, as after every start; limits, speeds and rules of the rig hold. It is limp at the "
      "end.\n"
      "From a script: words on the standard input, left, right, up, down, n, space, quit, or =1500 "
      "for a position; the\n"
      "next is taken when the servo has been told all of the way.");
  command->callback([options] { JogServo(*options); });
}

void AddServoMove(CLI::App& servo) {
  auto options = std::make_shared<MoveOptions>();
  CLI::App* command = servo.add_subcommand("move", "Move one servo to a position, then let it go");
  command->add_option("NAME", options->servo, "The servo's name in the rig")->required();
  command->add_option("POSITION", options->position, "In its own unit: microseconds or counts")
      ->required();
  AddConfigOption(*command, options->config);
  command->add_option("--seconds", options->seconds, "Hold it there so long")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3600.0));
  command->add_flag("--live", options->live,
                    "Have the running service do it: the performer keeps all other servos");
  command->footer("Limits, crawl, speeds and rules of the rig hold.");
  command->callback([options] { Move(*options); });
}

}  // namespace facewire::tools
