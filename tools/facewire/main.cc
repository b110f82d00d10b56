#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "app/error.h"
#include "tools/facewire/commands.h"

namespace {

// The exit codes are a contract with scripts (README.md of this folder).
constexpr int kFailed = 1;
constexpr int kBadInput = 2;

int Report(const std::string& what, int code) {
  std::fprintf(stderr, "facewire: %s\n", what.c_str());
  return code;
}

// What is wrong with the words of the command line, and whose --help tells more.
std::string Complaint(const CLI::App& facewire, const CLI::ParseError& error) {
  const CLI::App* command = &facewire;
  std::string name = "facewire";
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += " " + command->get_name();
  }
  std::string what = error.what();
  const auto rest = facewire.remaining(true);
  if (command->get_require_subcommand_min() > 0 && !rest.empty()) {
    what = "there is no '" + name + " " + rest.front() + "'";
  }
  return what + "; see " + name + " --help";
}

void AddCommands(CLI::App& facewire) {
  using namespace facewire::tools;  // NOLINT(google-build-using-namespace): this list and nothing
                                    // else
  AddTrack(facewire);
  AddRetarget(facewire);
  AddNeutralOf(facewire);
  AddRecord(facewire);
  AddPick(facewire);
  AddTrain(facewire);
  AddMonitor(facewire);
  AddBridge(facewire);
  AddCalibrate(facewire);
  AddBlend(facewire);
  AddStatus(facewire);
  AddService(facewire);
  AddSheet(facewire);
  AddServe(facewire);
  AddServo(facewire);
  AddRig(facewire);
  AddDoctor(facewire);
}

}  // namespace

// Only a wrong declaration of an option throws outside the try, and ending is right then.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
  CLI::App facewire("facewire: from a performer's face to a character's bones and blend shapes.",
                    "facewire");
  facewire.set_version_flag("--version", "facewire " FACEWIRE_VERSION);
  facewire.require_subcommand(1);
  facewire.get_formatter()->column_width(34);
  facewire.footer(
      "Exit codes: 0 done, 1 failed at work, 2 bad usage or bad input.\n"
      "`facewire COMMAND --help` tells more about a command.");
  AddCommands(facewire);
  try {
    facewire.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& wanted) {  // --help, --version
    return facewire.exit(wanted);
  } catch (const CLI::ParseError& error) {
    return Report(Complaint(facewire, error), kBadInput);
  } catch (const facewire::app::BadInput& error) {
    return Report(error.what(), kBadInput);
  } catch (const std::exception& error) {
    return Report(error.what(), kFailed);
  }
}
