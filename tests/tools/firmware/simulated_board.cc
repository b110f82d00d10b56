#include "tests/tools/firmware/simulated_board.h"

#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <variant>

namespace facewire::firmware {
namespace {

constexpr double kCyclesPerUs = 16;
// Ten bits at 115200 baud.
constexpr avr_cycle_count_t kCyclesPerByte = 1389;

constexpr std::size_t kMemoryBegin = 0x100;
constexpr std::uint8_t kUntouched = 0xA5;

// Port and bit of a servo's pin, or of A0 behind the last servo.
std::pair<char, int> PlaceOf(int pin) {
  if (pin < 6) return {'D', pin + 2};
  if (pin < 12) return {'B', pin - 6};
  return {'C', 0};
}

}  // namespace

SimulatedBoard::SimulatedBoard() : avr_(avr_make_mcu_by_name("atmega328p")) {
  avr_global_logger_set([](avr_t*, int, const char*, va_list) {});
  elf_firmware_t firmware = {};
  if (avr_ == nullptr || elf_read_firmware(FACEWIRE_FIRMWARE, &firmware) != 0) std::abort();
  avr_init(avr_);
  firmware.frequency = 16'000'000;
  avr_load_firmware(avr_, &firmware);
  std::free(firmware.flash);
  // As it may be after a power-on.
  std::fill(avr_->data + kMemoryBegin, avr_->data + avr_->ramend + 1, kUntouched);
  avr_->vcc = avr_->avcc = avr_->aref = 5000;

  // The firmware has no external interrupts; simavr would look for them in every cycle in which the
  // pins of the first two servos are low.
  for (const std::uint8_t interrupt : {std::uint8_t{0}, std::uint8_t{1}}) {
    avr_extint_set_strict_lvl_trig(avr_, interrupt, 0);
  }
  std::uint32_t flags = 0;
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  input_ = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
  avr_irq_register_notify(avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), OnByte,
                          this);
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    const auto [port, bit] = PlaceOf(static_cast<int>(i));
    pins_[i].board = this;
    avr_irq_register_notify(
        avr_io_getirq(avr_, static_cast<std::uint32_t>(AVR_IOCTL_IOPORT_GETIRQ(port)), bit), OnPin,
        &pins_[i]);
  }
}

SimulatedBoard::~SimulatedBoard() { avr_terminate(avr_); }

void SimulatedBoard::OnPin(avr_irq_t*, std::uint32_t value, void* pin) {
  Pin& p = *static_cast<Pin*>(pin);
  const bool high = value != 0;
  if (high == p.high) return;
  p.high = high;
  const std::uint64_t now = p.board->avr_->cycle;
  if (high) {
    p.rose = now;
  } else {
    p.pulses.push_back({.start_us = static_cast<double>(p.rose) / kCyclesPerUs,
                        .width_us = static_cast<double>(now - p.rose) / kCyclesPerUs});
  }
}

void SimulatedBoard::OnByte(avr_irq_t*, std::uint32_t value, void* board) {
  auto& self = *static_cast<SimulatedBoard*>(board);
  const auto byte = static_cast<std::byte>(value);
  self.bytes_.push_back(byte);
  std::span<const std::byte> bytes(&byte, 1);
  while (const auto received = self.decoder_.Next(bytes)) {
    if (const auto* status = std::get_if<wire::ReceiverStatus>(&received->message)) {
      self.status_.push_back(*status);
    }
  }
}

std::uint64_t SimulatedBoard::OnNextByte(avr_t*, std::uint64_t when, void* board) {
  auto& self = *static_cast<SimulatedBoard*>(board);
  if (self.to_send_.empty()) {
    self.sending_ = false;
    return 0;
  }
  avr_raise_irq(self.input_, std::to_integer<std::uint32_t>(self.to_send_.front()));
  self.to_send_.pop_front();
  return when + kCyclesPerByte;
}

void SimulatedBoard::Send(std::span<const std::byte> bytes) {
  to_send_.insert(to_send_.end(), bytes.begin(), bytes.end());
  if (sending_ || to_send_.empty()) return;
  sending_ = true;
  avr_cycle_timer_register(avr_, kCyclesPerByte, OnNextByte, this);
}

// Whether the instruction that stood at `before` jumped back to where the one before it did, with
// the same registers and interrupts open: one turn of a loop that computes nothing. An interrupt
// routine that waits for an edge has them closed.
bool SimulatedBoard::Waits(std::uint32_t before) noexcept {
  if (avr_->pc >= before || avr_->sreg[S_I] == 0) return false;
  const bool same =
      avr_->pc == jumped_to_ && std::equal(registers_.begin(), registers_.end(), avr_->data);
  jumped_to_ = avr_->pc;
  std::copy_n(avr_->data, registers_.size(), registers_.begin());
  return same;
}

void SimulatedBoard::RunFor(double ms) {
  const avr_cycle_count_t end =
      avr_->cycle + static_cast<avr_cycle_count_t>(ms * 1000 * kCyclesPerUs);
  while (avr_->cycle < end) {
    const avr_flashaddr_t before = avr_->pc;
    if (avr_run(avr_) == cpu_Crashed) std::abort();
    if (!Waits(before)) continue;
    const avr_cycle_timer_slot_t* next = avr_->cycle_timers.timer;
    const avr_cycle_count_t until = next != nullptr ? std::min(next->when, end) : end;
    avr_->cycle = std::max(avr_->cycle, until);
  }
}

double SimulatedBoard::now_ms() const {
  return static_cast<double>(avr_->cycle) / kCyclesPerUs / 1000;
}

std::vector<SimulatedBoard::Pulse> SimulatedBoard::TakePulses(std::size_t servo) {
  return std::exchange(pins_[servo].pulses, {});
}

std::vector<wire::ReceiverStatus> SimulatedBoard::TakeStatus() {
  return std::exchange(status_, {});
}

std::vector<std::byte> SimulatedBoard::TakeBytes() { return std::exchange(bytes_, {}); }

bool SimulatedBoard::AnyServoHigh() const {
  return std::any_of(pins_.begin(), pins_.begin() + kServos, [](const Pin& p) { return p.high; });
}

std::size_t SimulatedBoard::UntouchedBytes() const {
  std::size_t longest = 0;
  std::size_t run = 0;
  for (std::size_t at = kMemoryBegin; at <= avr_->ramend; ++at) {
    run = avr_->data[at] == kUntouched ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

void SimulatedBoard::Hang() {
  constexpr avr_flashaddr_t kFree = 0x7000;  // far behind the program
  avr_->flash[kFree] = 0xFF;                 // rjmp to itself
  avr_->flash[kFree + 1] = 0xCF;
  avr_->pc = kFree;
}

void SimulatedBoard::Reset() { avr_reset(avr_); }

}  // namespace facewire::firmware
