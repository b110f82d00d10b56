#ifndef FACEWIRE_TESTS_CORE_WIRE_RAW_FRAME_H_
#define FACEWIRE_TESTS_CORE_WIRE_RAW_FRAME_H_

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

namespace facewire::wire {

using Bytes = std::vector<std::byte>;

// A second, plain way to make frames from core/wire/README.md: no state, no streaming, any content.
Bytes MakeBytes(std::initializer_list<int> values);
Bytes CobsEncode(std::span<const std::byte> plain);
Bytes WithCrc(Bytes inside);
// With both delimiters.
Bytes RawFrame(int version, int type, int sequence, std::span<const std::byte> payload);
Bytes operator+(const Bytes& a, const Bytes& b);

}  // namespace facewire::wire

#endif  // FACEWIRE_TESTS_CORE_WIRE_RAW_FRAME_H_
