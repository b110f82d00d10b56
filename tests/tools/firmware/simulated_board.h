#ifndef FACEWIRE_TESTS_TOOLS_FIRMWARE_SIMULATED_BOARD_H_
#define FACEWIRE_TESTS_TOOLS_FIRMWARE_SIMULATED_BOARD_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "core/wire/decoder.h"
#include "core/wire/message.h"

struct avr_t;
struct avr_irq_t;

namespace facewire::firmware {

// An ATmega328P at 16 MHz that runs the firmware, with something to watch its twelve pins and the
// other end of its line. Times are us since the start, to a cycle. While the program turns in a
// loop that waits for an interrupt or a timer, simulated time leaps to the next of either: nothing
// else can end the loop.
class SimulatedBoard {
 public:
  struct Pulse {
    double start_us = 0;
    double width_us = 0;
  };

  static constexpr std::size_t kServos = 12;

  SimulatedBoard();
  ~SimulatedBoard();
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;

  // Bytes to its line, one behind the other at 115200 baud.
  void Send(std::span<const std::byte> bytes);
  void RunFor(double ms);
  double now_ms() const;

  // The whole pulses that ended since the last call.
  std::vector<Pulse> TakePulses(std::size_t servo);
  // When the firmware computed, as it shows at A0.
  std::vector<Pulse> TakeBusy() { return TakePulses(kServos); }
  std::vector<wire::ReceiverStatus> TakeStatus();
  // The same as bytes, as they came from its line.
  std::vector<std::byte> TakeBytes();
  const wire::LinkStats& received() const { return decoder_.stats(); }

  // Bytes of its memory that were never written: between what is static and the deepest stack.
  std::size_t UntouchedBytes() const;

  // What a bug would do to the program: it stays where it is, with its interrupts.
  void Hang();
  // The reset pin.
  void Reset();
  bool AnyServoHigh() const;

 private:
  struct Pin {
    SimulatedBoard* board = nullptr;
    bool high = false;
    std::uint64_t rose = 0;
    std::vector<Pulse> pulses;
  };
  static void OnPin(avr_irq_t* irq, std::uint32_t value, void* pin);
  static void OnByte(avr_irq_t* irq, std::uint32_t value, void* board);
  static std::uint64_t OnNextByte(avr_t* avr, std::uint64_t when, void* board);
  bool Waits(std::uint32_t before) noexcept;

  avr_t* avr_;
  avr_irq_t* input_;
  std::array<Pin, kServos + 1> pins_;  // of the servos, and A0
  // Where it last jumped back, and its registers then.
  std::uint32_t jumped_to_ = 0;
  std::array<std::uint8_t, 32> registers_{};
  std::deque<std::byte> to_send_;
  bool sending_ = false;
  wire::Decoder decoder_;
  std::vector<wire::ReceiverStatus> status_;
  std::vector<std::byte> bytes_;
};

}  // namespace facewire::firmware

#endif  // FACEWIRE_TESTS_TOOLS_FIRMWARE_SIMULATED_BOARD_H_
