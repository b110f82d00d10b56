#include <CLI/CLI.hpp>

#include "tools/facewire/commands.h"
#include "tools/facewire/servo/verbs.h"

namespace facewire::tools {

void AddServo(CLI::App& facewire) {
  CLI::App* servo =
      facewire.add_subcommand("servo", "Servo buses: find them, see, move and set up their servos");
  servo->require_subcommand(1);
  servo->get_formatter()->column_width(34);
  servo->footer("`facewire servo VERB --help` tells more about a verb.");
  AddServoFind(*servo);
  AddServoList(*servo);
  AddServoJog(*servo);
  AddServoMove(*servo);
  AddServoLimits(*servo);
  AddServoSet(*servo);
  AddServoReboot(*servo);
  AddServoWizard(*servo);
}

}  // namespace facewire::tools
