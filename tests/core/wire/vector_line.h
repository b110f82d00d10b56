#ifndef FACEWIRE_TESTS_CORE_WIRE_VECTOR_LINE_H_
#define FACEWIRE_TESTS_CORE_WIRE_VECTOR_LINE_H_

#include <array>
#include <cstddef>
#include <vector>

#include "core/wire/encoder.h"
#include "tests/core/wire/vectors.h"

namespace facewire::wire {

// One line with its encoder: frames are numbered from 0.
class Line {
 public:
  Bytes Send(const Message& message) {
    std::array<std::byte, kMaxFrameBytes> buffer;
    const auto frame = encoder_.Encode(message, buffer).value();
    return {frame.begin(), frame.end()};
  }

 private:
  Encoder encoder_;
};

// The vectors of the messages between a device and a receiver of servo pulses.
void AddServos(std::vector<Vector>& all);
// Those of landmarks.
void AddLandmarks(std::vector<Vector>& all);

}  // namespace facewire::wire

#endif  // FACEWIRE_TESTS_CORE_WIRE_VECTOR_LINE_H_
