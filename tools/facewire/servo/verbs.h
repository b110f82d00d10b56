#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_VERBS_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_VERBS_H_

namespace CLI {
class App;
}

// One function a verb of `facewire servo`, as in commands.h.
namespace facewire::tools {

void AddServoFind(CLI::App& servo);
void AddServoList(CLI::App& servo);
void AddServoJog(CLI::App& servo);
void AddServoMove(CLI::App& servo);
void AddServoLimits(CLI::App& servo);
void AddServoSet(CLI::App& servo);
void AddServoReboot(CLI::App& servo);
void AddServoWizard(CLI::App& servo);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_VERBS_H_
