#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_EEPROM_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_EEPROM_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/animatronic/bus_config.h"
#include "hal/clock.h"
#include "hal/serial_port.h"
#include "tools/facewire/servo/eeprom_chain.h"
#include "tools/facewire/servo/line.h"

namespace facewire::tools {

// What one servo keeps without power, changed a setting at a time by an operator's command.
class Eeprom {
 public:
  // Makes the port of a bus; not open.
  using MakePort = std::function<std::unique_ptr<hal::SerialPort>(const app::ServoBusConfig&)>;

  // `clock` is borrowed.
  Eeprom(app::ServoBusConfig bus, std::uint8_t id, MakePort make, hal::Clock& clock);
  Eeprom(const Eeprom&) = delete;
  Eeprom& operator=(const Eeprom&) = delete;

  // Opens the port and finds the servo. Throws BadInput (the port; nothing is kept on such a bus),
  // Failure (it does not answer).
  void Open();
  // Writes and reads back. `setting` as the findings name it, or "id", or "baud" in bits a second.
  // Throws BadInput (not a setting of this servo, not a value for it, an id that another servo
  // has), Failure (refused, not acknowledged, or something else is read back).
  void Set(std::string_view setting, std::string_view value);
  // Starts it anew and waits until it answers again. Throws Failure.
  void Reboot();

 private:
  void OpenPort();
  void Require(bool good, const std::string& why) const;

  app::ServoBusConfig bus_;
  std::uint8_t id_;
  MakePort make_;
  hal::Clock& clock_;
  std::unique_ptr<hal::SerialPort> port_;
  std::optional<Line> line_;
  std::unique_ptr<EepromChain> chain_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_EEPROM_H_
