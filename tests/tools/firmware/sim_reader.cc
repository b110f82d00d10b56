// sim_reader READER.elf FILE.bin: what a program on a simulated ATmega1284P (avr/reader.c) makes of
// a stream of bytes that comes to it at 115200 baud, as it writes it.
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_io.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace {

// At 115200 baud and 16 MHz; simavr's line takes eleven bits a byte, parity or not.
constexpr avr_cycle_count_t kCyclesPerByte = 1528;
constexpr avr_cycle_count_t kStart = 160'000;  // 10 ms
constexpr avr_cycle_count_t kSilence = 10 * kCyclesPerByte;
constexpr avr_io_addr_t kCharacter = 0x3E;  // GPIOR0
constexpr avr_io_addr_t kOver = 0x4A;       // GPIOR1

struct Line {
  std::string bytes;
  std::size_t sent = 0;
  avr_cycle_count_t end = 0;  // when the program is told that nothing more comes
  avr_irq_t* input = nullptr;
};

avr_cycle_count_t OnNextByte(avr_t* avr, avr_cycle_count_t when, void* param) {
  Line& line = *static_cast<Line*>(param);
  if (line.sent == line.bytes.size()) {
    avr->data[kOver] = when >= line.end ? 1 : 0;
    return when >= line.end ? 0 : line.end;
  }
  line.end = when + kSilence;
  avr_raise_irq(line.input, static_cast<std::uint8_t>(line.bytes[line.sent]));
  ++line.sent;
  return when + kCyclesPerByte;
}

void OnCharacter(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void*) {
  avr->data[address] = value;
  (void)std::fputc(value, stdout);
}

int Run(const char* program, const char* stream) {
  std::ifstream in(stream, std::ios::binary);
  if (!in) {
    (void)std::fprintf(stderr, "sim_reader: cannot read %s\n", stream);
    return 2;
  }
  Line line{.bytes = {std::istreambuf_iterator<char>(in), {}}};

  avr_global_logger_set([](avr_t*, int, const char*, va_list) {});
  avr_t* const avr = avr_make_mcu_by_name("atmega1284p");
  elf_firmware_t firmware = {};
  if (avr == nullptr || elf_read_firmware(program, &firmware) != 0) {
    (void)std::fprintf(stderr, "sim_reader: cannot run %s\n", program);
    return 2;
  }
  avr_init(avr);
  firmware.frequency = 16'000'000;
  avr_load_firmware(avr, &firmware);
  std::uint32_t flags = 0;
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  line.input = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
  avr_register_io_write(avr, kCharacter, OnCharacter, nullptr);
  // By then the program has cleared its memory and opened its line.
  avr_cycle_timer_register(avr, kStart, OnNextByte, &line);

  int state = cpu_Running;
  while (state != cpu_Done && state != cpu_Crashed) state = avr_run(avr);
  avr_terminate(avr);
  return state == cpu_Done ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    (void)std::fputs("usage: sim_reader READER.elf FILE.bin\n", stderr);
    return 2;
  }
  return Run(argv[1], argv[2]);
}
