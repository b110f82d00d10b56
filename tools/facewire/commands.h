#ifndef FACEWIRE_TOOLS_FACEWIRE_COMMANDS_H_
#define FACEWIRE_TOOLS_FACEWIRE_COMMANDS_H_

namespace CLI {
class App;
}

// One function a subcommand, most in a file of their own. It adds options and a callback to a fresh
// subcommand; the callback reports errors as app::BadInput (exit code 2) or app::Failure (1).
namespace facewire::tools {

void AddTrack(CLI::App& facewire);
void AddRetarget(CLI::App& facewire);
void AddNeutralOf(CLI::App& facewire);
void AddRecord(CLI::App& facewire);
void AddPick(CLI::App& facewire);
void AddTrain(CLI::App& facewire);
void AddMonitor(CLI::App& facewire);
void AddBridge(CLI::App& facewire);
void AddCalibrate(CLI::App& facewire);
void AddBlend(CLI::App& facewire);
void AddStatus(CLI::App& facewire);
void AddService(CLI::App& facewire);  // neutral, stop, release, reload
void AddSheet(CLI::App& facewire);
void AddServe(CLI::App& facewire);
void AddServo(CLI::App& facewire);  // servo/: find, list, jog, ...
void AddRig(CLI::App& facewire);    // import, check, show
void AddDoctor(CLI::App& facewire);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_COMMANDS_H_
