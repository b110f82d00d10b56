#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_OPEN_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_OPEN_H_

#include <string>

#include "app/animatronic/servo_output.h"

namespace CLI {
class App;
}

namespace facewire::tools {

// A line about a port that is in use ends with what to do when it is the service that has it.
std::string WithService(const std::string& line);

// Opens the ports. Throws BadInput as ServoOutput::Open, with that advice.
void OpenOutput(app::ServoOutput& output);

inline constexpr const char* kUsualConfig = "/etc/facewire/facewire.toml";
// --config of the verbs.
void AddConfigOption(CLI::App& command, std::string& config);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_OPEN_H_
