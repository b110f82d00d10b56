#ifndef FACEWIRE_CORE_WIRE_DYNAMIXEL_REGISTERS_H_
#define FACEWIRE_CORE_WIRE_DYNAMIXEL_REGISTERS_H_

#include <cstdint>

namespace facewire::wire::dynamixel {

// A place in a servo's control table. Values are little-endian, signed ones two's complement.
struct Register {
  std::uint16_t address = 0;
  std::uint16_t bytes = 0;
};

// The control table of the X series (XL330, XC330, XL430, XC430, XM, XH, XD, XW), from the tables
// in emanual.robotis.com/docs/en/dxl/x/; what is listed here is the same in all of them. The XL-320
// has another table.
namespace x {

// EEPROM: written only while torque is off.
inline constexpr Register kModel{0, 2};
inline constexpr Register kFirmware{6, 1};
inline constexpr Register kId{7, 1};
inline constexpr Register kBaudRate{8, 1};        // 0: 9600, 1: 57600, 2: 115200, 3: 1M, 4: 2M ...
inline constexpr Register kReturnDelay{9, 1};     // 2 us, 0 to 254; delivered with 250
inline constexpr Register kDriveMode{10, 1};      // bit 0: reverse; bit 2: profile in ms
inline constexpr Register kOperatingMode{11, 1};  // an OperatingMode
inline constexpr Register kTemperatureLimit{31, 1};  // degrees C
inline constexpr Register kCurrentLimit{38, 2};      // in the unit of the present current; models
                                                     // without a current sensor have nothing here
inline constexpr Register kMaxPosition{48, 4};       // counts
inline constexpr Register kMinPosition{52, 4};       // counts
inline constexpr Register kShutdown{63, 1};          // HardwareError bits that switch torque off

// RAM.
inline constexpr Register kTorqueEnable{64, 1};
inline constexpr Register kStatusReturn{68, 1};          // 0: ping only, 1: reads too, 2: all
inline constexpr Register kHardwareError{70, 1};         // HardwareError bits, until a reboot
inline constexpr Register kBusWatchdog{98, 1};           // 20 ms; 0: off, clears; FF: has tripped
inline constexpr Register kProfileAcceleration{108, 4};  // 214.577 rev/min^2; 0: unlimited
inline constexpr Register kProfileVelocity{112, 4};      // 0.229 rev/min; 0: unlimited
inline constexpr Register kGoalPosition{116, 4};         // counts
inline constexpr Register kPresentLoad{126, 2};  // signed, 0.1 %; current in mA (or 2.69 mA) where
                                                 // the model has a current sensor
inline constexpr Register kPresentPosition{132, 4};     // counts, signed
inline constexpr Register kPresentVoltage{144, 2};      // 0.1 V
inline constexpr Register kPresentTemperature{146, 1};  // degrees C

}  // namespace x

inline constexpr int kCountsPerTurn = 4096;
inline constexpr std::uint8_t kWatchdogTripped = 0xFF;
inline constexpr int kMaxWatchdog = 127;  // of 20 ms

enum class OperatingMode : std::uint8_t {
  kCurrent = 0,
  kVelocity = 1,
  kPosition = 3,
  kExtendedPosition = 4,
  kCurrentBasedPosition = 5,
  kPwm = 16,
};

// Bits of the registers kHardwareError and kShutdown.
enum class HardwareError : std::uint8_t {
  kVoltage = 1U << 0U,
  kHeat = 1U << 2U,
  kEncoder = 1U << 3U,
  kShock = 1U << 4U,
  kOverload = 1U << 5U,
};

}  // namespace facewire::wire::dynamixel

#endif  // FACEWIRE_CORE_WIRE_DYNAMIXEL_REGISTERS_H_
