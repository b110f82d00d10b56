#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_VERBS_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_VERBS_H_

#include <string>

namespace CLI {
class App;
}

// One function a verb of `facewire servo`, as in commands.h.
namespace facewire::tools {

void AddServoFind(CLI::App& servo);

// A line about a port that is in use ends with what to do when it is the service that has it.
std::string WithService(const std::string& line);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_VERBS_H_
