#ifndef FACEWIRE_CORE_WIRE_FEETECH_REGISTERS_H_
#define FACEWIRE_CORE_WIRE_FEETECH_REGISTERS_H_

#include <cstdint>

namespace facewire::wire::feetech {

// A place in a servo's memory.
struct Register {
  std::uint8_t address = 0;
  std::uint8_t bytes = 0;
};

// The memory of the STS and SMS series, from Feetech's table and its library (README.md here).
// Two-byte values have the low byte first; signed ones are sign and magnitude.
namespace sts {

// EEPROM: kept without power only when written while kLock is 0.
inline constexpr Register kModel{3, 2};
inline constexpr Register kId{5, 1};
inline constexpr Register kBaudRate{6, 1};     // 0: 1M, 1: 500k, 2: 250k, 3: 128k, 4: 115200 ...
inline constexpr Register kReturnDelay{7, 1};  // 2 us
inline constexpr Register kMinAngle{9, 2};     // counts; both 0: turns without end
inline constexpr Register kMaxAngle{11, 2};
inline constexpr Register kMaxTemperature{13, 1};  // degrees C
inline constexpr Register kPhase{18, 1};           // Phase bits
inline constexpr Register kUnload{19, 1};          // ServoError bits that switch torque off
inline constexpr Register kMode{33, 1};            // a Mode

// RAM.
inline constexpr Register kTorqueEnable{40, 1};  // 128 makes the place where it stands the middle
inline constexpr Register kAcceleration{41, 1};  // 100 counts/s^2; 0: unlimited
inline constexpr Register kGoalPosition{42, 2};  // counts, sign bit 15
inline constexpr Register kGoalTime{44, 2};
inline constexpr Register kGoalSpeed{46, 2};        // counts/s or 50 counts/s: kPhase says which
inline constexpr Register kLock{55, 1};             // 1: EEPROM is not written
inline constexpr Register kPresentPosition{56, 2};  // counts, sign bit 15
inline constexpr Register kPresentSpeed{58, 2};
inline constexpr Register kPresentLoad{60, 2};         // 0.1 % of full PWM, sign bit 10
inline constexpr Register kPresentVoltage{62, 1};      // 0.1 V
inline constexpr Register kPresentTemperature{63, 1};  // degrees C
inline constexpr Register kStatus{65, 1};              // ServoError bits, as in every reply
inline constexpr Register kMoving{66, 1};
inline constexpr Register kPresentCurrent{69, 2};  // 6.5 mA

}  // namespace sts

// What is different in the SCS series: two-byte values have the high byte first, a turn of 300
// degrees has 1024 counts, there is no acceleration, no mode and no phase; and the lock is
// elsewhere.
namespace scs {

inline constexpr Register kLock{48, 1};

}  // namespace scs

inline constexpr int kCountsPerTurn = 4096;
inline constexpr unsigned kPositionSign = 15;
inline constexpr unsigned kLoadSign = 10;

enum class Mode : std::uint8_t { kPosition = 0, kSpeed = 1, kPwm = 2, kStep = 3 };

// Bits of kPhase.
inline constexpr unsigned kPhaseFineSpeed = 1U << 2U;  // speeds count 0.0146 rev/min, not 0.732

// Bits of every reply, of kStatus and of kUnload.
enum class ServoError : std::uint8_t {
  kVoltage = 1U << 0U,
  kEncoder = 1U << 1U,
  kHeat = 1U << 2U,
  kCurrent = 1U << 3U,
  kOverload = 1U << 5U,
};

}  // namespace facewire::wire::feetech

#endif  // FACEWIRE_CORE_WIRE_FEETECH_REGISTERS_H_
