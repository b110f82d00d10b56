#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_INSTALLATION_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_INSTALLATION_H_

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "core/servo/servo_rig.h"

namespace facewire::tools {

// The servos of a configuration and the buses that they hang on.
struct Installation {
  std::filesystem::path rig_file;
  std::filesystem::path control;  // the service's socket; empty: it has none
  std::vector<app::ServoBusConfig> buses;
  servo::ServoRig servos;
};

// Reads facewire.toml and the servos of its rig. Throws BadInput, also when there is no [[bus]].
Installation LoadInstallation(const std::filesystem::path& config);
// As it is needed to move or ask servos: the buses without any are left out. Throws BadInput when
// the rig has no servo.
Installation WithServos(Installation all);

// Index of the servo of that name. Throws BadInput with what may have been meant.
std::size_t FindServo(const Installation& installation, std::string_view name);
// The bus of that name; throws BadInput.
const app::ServoBusConfig& FindBus(const Installation& installation, std::string_view name);

// What has to be there to move one servo: it and those that rules (linkages) join to it, and their
// buses.
Installation PartOf(const Installation& all, std::size_t servo);

// The positions that a servo of this kind of bus may have at all, in its own unit.
struct WholeWay {
  float low = 0;
  float high = 0;
};
WholeWay WholeWayOf(const app::ServoBusConfig& bus);
const char* UnitOf(const app::ServoBusConfig& bus);  // "us" or "counts"

// One servo whose limits are being looked for: it may go the whole way, alone, and no faster than
// its crawl. `known` brings name, bus, id and, when it is limited already, speed and neutral; a
// servo without takes 20 s for the whole way and rests in its middle.
Installation Alone(const app::ServoBusConfig& bus, const servo::Servo& known);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_INSTALLATION_H_
