#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_EEPROM_CHAIN_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_EEPROM_CHAIN_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "tools/facewire/servo/line.h"

namespace facewire::tools {

// One setting as bytes at a place of a servo's memory.
struct EepromItem {
  std::uint16_t address = 0;
  std::vector<std::byte> data;
  // The packets that write it, one after the other; the servo acknowledges each, unless it has
  // another id or rate from then on.
  std::vector<std::vector<std::byte>> packets;
  std::optional<std::uint8_t> new_id;
  std::optional<int> new_baud;
};

// What is different in how kinds of servos keep settings.
class EepromChain {
 public:
  virtual ~EepromChain() = default;

  virtual bool Finds(std::uint8_t id) = 0;
  // Throws BadInput: not a setting of such servos, or not a value for it.
  virtual EepromItem Make(std::uint8_t id, std::string_view setting, std::string_view value) = 0;
  // Throws Failure: not acknowledged, refused.
  virtual void Write(std::uint8_t id, const EepromItem& item) = 0;
  // After the last write, by its new id and at its new rate: its memory is closed again.
  virtual void Close(std::uint8_t id) = 0;
  // nullopt: no answer.
  virtual std::optional<std::vector<std::byte>> Read(std::uint8_t id, const EepromItem& item) = 0;
  virtual void Reboot(std::uint8_t id) = 0;
};

// Both borrowed. nullptr: servos of this kind keep nothing that a line could change.
std::unique_ptr<EepromChain> MakeEepromChain(const app::ServoBusConfig& bus, Line& line);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_EEPROM_CHAIN_H_
