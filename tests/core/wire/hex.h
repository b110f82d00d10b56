#ifndef FACEWIRE_TESTS_CORE_WIRE_HEX_H_
#define FACEWIRE_TESTS_CORE_WIRE_HEX_H_

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace facewire::wire {

// Bytes as people write them: "FF FF 01 02".
inline std::string Hex(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (std::byte b : bytes) {
    if (!text.empty()) text += ' ';
    text += kDigits[std::to_integer<std::size_t>(b) >> 4U];
    text += kDigits[std::to_integer<std::size_t>(b) & 0x0FU];
  }
  return text;
}
// A template, so that nothing is converted to a Result.
template <class T>
std::string Hex(const Result<T>& packet) {
  return packet ? Hex(*packet) : Name(packet.error());
}

inline std::vector<std::byte> FromHex(std::string_view text) {
  std::vector<std::byte> bytes;
  int high = -1;
  for (char c : text) {
    const std::size_t digit = std::string_view("0123456789ABCDEF").find(c);
    if (digit == std::string_view::npos) continue;
    const int value = static_cast<int>(digit);
    if (high >= 0) bytes.push_back(static_cast<std::byte>(high * 16 + value));
    high = high >= 0 ? -1 : value;
  }
  return bytes;
}

// One packet made by make(std::span<std::byte> out).
template <class Make>
std::vector<std::byte> Made(Make make) {
  std::array<std::byte, 1024> buffer{};
  const auto packet = make(std::span<std::byte>(buffer));
  return packet ? std::vector<std::byte>(packet->begin(), packet->end()) : std::vector<std::byte>();
}

}  // namespace facewire::wire

#endif  // FACEWIRE_TESTS_CORE_WIRE_HEX_H_
