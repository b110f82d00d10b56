#ifndef FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_LINE_H_
#define FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_LINE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/wire/encoder.h"
#include "core/wire/message.h"
#include "tests/core/wire/raw_frame.h"

namespace facewire::firmware {

using wire::Bytes;
using wire::operator+;

// The device's end of a line to a receiver.
class Line {
 public:
  Bytes Send(const wire::Message& message);

 private:
  wire::Encoder encoder_;
};

// Twelve servos, 1000 .. 1500 .. 2000 us, 4000 us/s, ramps of 500 us/s and 2000 us/s^2; holds 200
// ms, eases in 400 ms, releases after 300 ms more.
wire::ServoSetup TwelveServos(std::uint32_t setup_id = 7);

// All twelve at one width.
wire::ServoPulses AllAt(int us, std::uint32_t setup_id = 7);

// What a receiver makes of a stream, to compare the decoders of two languages: the messages to a
// receiver of twelve servos, as JSON, and the counts that the firmware has.
struct Reading {
  std::vector<std::string> messages;
  std::vector<std::uint64_t> counts;
  bool operator==(const Reading&) const = default;
};
Reading ReadByFirmware(const Bytes& stream);
Reading ReadByDevice(const Bytes& stream);

}  // namespace facewire::firmware

#endif  // FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_LINE_H_
