// facewire servo set, reboot: one servo's own settings, and a new start.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/devices.h"
#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/servo/ask.h"
#include "tools/facewire/servo/eeprom.h"
#include "tools/facewire/servo/installation.h"
#include "tools/facewire/servo/open.h"
#include "tools/facewire/servo/setting_value.h"
#include "tools/facewire/servo/verbs.h"

namespace facewire::tools {
namespace {

struct SetOptions {
  std::string servo;
  std::string setting;
  std::string value;
  std::string config = kUsualConfig;
  int baud = 0;  // 0: the bus's
  bool yes = false;
};

struct Target {
  app::ServoBusConfig bus;
  std::uint8_t id = 0;
};

// A servo of the rig by its name, or any that is there as BUS/ID.
Target FindTarget(const SetOptions& options) {
  const Installation all = LoadInstallation(options.config);
  Target target;
  const std::size_t slash = options.servo.find('/');
  if (slash == std::string::npos) {
    const servo::Servo& servo = all.servos.servos[FindServo(all, options.servo)];
    target = {FindBus(all, servo.bus.view()), servo.id};
  } else {
    const auto id = WholeNumber(std::string_view(options.servo).substr(slash + 1));
    if (!id || *id < 0 || *id > 253) {
      throw app::BadInput(options.servo + ": after the / comes an id, 0 to 253");
    }
    target = {FindBus(all, options.servo.substr(0, slash)), static_cast<std::uint8_t>(*id)};
  }
  if (options.baud != 0) target.bus.baud = options.baud;
  return target;
}

std::unique_ptr<Eeprom> OpenServo(const Target& target, hal::Clock& clock) {
  auto servo = std::make_unique<Eeprom>(
      target.bus, target.id,
      [](const app::ServoBusConfig& bus) { return app::MakeHostLine(bus.port, bus.baud); }, clock);
  servo->Open();
  return servo;
}

bool Agreed(const SetOptions& options, const std::string& question) {
  return options.yes || AskYes(question, false);
}

void Set(const SetOptions& options) {
  hal::SystemClock clock;
  const Target target = FindTarget(options);
  const auto servo = OpenServo(target, clock);
  if (!Agreed(options, "Write " + options.setting + " = " + options.value + " into " +
                           options.servo + ", for good?")) {
    throw app::Failure("nothing was written");
  }
  servo->Set(options.setting, options.value);
  std::printf("%s: %s is %s now, as read back\n", options.servo.c_str(), options.setting.c_str(),
              options.value.c_str());
  if (options.setting == "id") {
    std::printf("write it into the rig, too: id = %s\n", options.value.c_str());
  }
  if (options.setting == "baud") {
    std::printf(
        "write it into the configuration, too: baud = %s in the [[bus]] \"%s\", whose servos must "
        "all have it\n",
        options.value.c_str(), target.bus.name.c_str());
  }
}

void Reboot(const SetOptions& options) {
  hal::SystemClock clock;
  const auto servo = OpenServo(FindTarget(options), clock);
  if (!Agreed(options, options.servo + " loses its torque while it starts; reboot it?")) {
    throw app::Failure("nothing was done");
  }
  servo->Reboot();
  std::printf("%s is back\n", options.servo.c_str());
}

void AddTarget(CLI::App& command, SetOptions& options) {
  command
      .add_option("NAME", options.servo,
                  "The servo's name in the rig, or BUS/ID for one that is in no rig yet")
      ->required();
}
void AddRest(CLI::App& command, SetOptions& options) {
  AddConfigOption(command, options.config);
  command
      .add_option("--baud", options.baud, "Reach it at this rate, if it is not yet that of its bus")
      ->check(CLI::Range(1200, 10'000'000));
  command.add_flag("--yes", options.yes, "Do not ask");
}

}  // namespace

void AddServoSet(CLI::App& servo) {
  auto options = std::make_shared<SetOptions>();
  CLI::App* command =
      servo.add_subcommand("set", "Write one setting that a servo keeps, and read it back");
  AddTarget(*command, *options);
  command->add_option("SETTING", options->setting, "Which, by its name below")->required();
  command->add_option("VALUE", options->value, "As `facewire servo list` says it should be")
      ->required();
  AddRest(*command, *options);
  command->footer(
      "Settings: mode (3 on a Dynamixel and 0 on a Feetech is position), min-position, "
      "max-position (counts), shutdown\n"
      "(heat,electricalshock,overload), return-delay (us), profile-unit (speed, time), lock (open, "
      "closed),\n"
      "id, and baud in bits a second. New servos all have id 1: connect them one at a time and "
      "give each\n"
      "its own, as in `facewire servo set head/1 id 5`.");
  command->callback([options] { Set(*options); });
}

void AddServoReboot(CLI::App& servo) {
  auto options = std::make_shared<SetOptions>();
  CLI::App* command = servo.add_subcommand(
      "reboot", "Start one servo anew, which clears errors that have switched it off");
  AddTarget(*command, *options);
  AddRest(*command, *options);
  command->footer("Dynamixel and Feetech servos.");
  command->callback([options] { Reboot(*options); });
}

}  // namespace facewire::tools
