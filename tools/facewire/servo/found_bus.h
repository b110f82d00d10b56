#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_FOUND_BUS_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_FOUND_BUS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// What a search for servo buses finds, and how it is told.
namespace facewire::tools {

enum class Protocol : std::uint8_t { kReceiver, kMaestro, kDynamixel, kFeetech };
const char* KindOf(Protocol protocol);  // as in [[bus]]: "dynamixel"
const char* Name(Protocol protocol);    // for a person: "Dynamixel"

struct FoundServo {
  std::uint8_t id = 0;
  std::string model{};
  std::optional<int> position{};  // counts
  std::optional<float> temperature_c{};
  std::optional<float> voltage_v{};
};

struct FoundBus {
  Protocol protocol = Protocol::kDynamixel;
  std::string port{};  // a path
  int baud = 0;
  std::string about{};               // of a controller: what it says of itself
  std::vector<FoundServo> servos{};  // of a chain
  bool crc = false;                  // of a Maestro: packets end with a CRC
  bool scs = false;                  // of a Feetech chain: SCS servos
};

// Some lines: the bus, and a table of its servos.
std::string Describe(const FoundBus& bus);
// A [[bus]] of facewire.toml, ready to be pasted.
std::string BusBlock(const FoundBus& bus, const std::string& name);

// The maker's name for a model number, or the number.
std::string DynamixelModel(std::uint16_t number);
std::string FeetechModel(std::uint16_t number, bool scs);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_FOUND_BUS_H_
