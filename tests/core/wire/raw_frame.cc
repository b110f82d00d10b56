#include "tests/core/wire/raw_frame.h"

#include <algorithm>

namespace facewire::wire {

Bytes MakeBytes(std::initializer_list<int> values) {
  Bytes out;
  for (int v : values) out.push_back(static_cast<std::byte>(v));
  return out;
}

Bytes operator+(const Bytes& a, const Bytes& b) {
  Bytes out = a;
  out.insert(out.end(), b.begin(), b.end());
  return out;
}

// Cuts the bytes plus one imagined zero at every zero and after every 254 bytes, and puts the
// distance to the next cut before each part.
Bytes CobsEncode(std::span<const std::byte> plain) {
  Bytes out;
  std::size_t at = 0;
  while (true) {
    const auto rest = plain.subspan(at);
    const auto zero = std::find(rest.begin(), rest.end(), std::byte{0});
    const auto run = std::min<std::size_t>(static_cast<std::size_t>(zero - rest.begin()), 254);
    out.push_back(static_cast<std::byte>(run + 1));
    out.insert(out.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(run));
    at += run;
    const bool full = run == 254;
    if (at == plain.size()) return out;
    if (!full) ++at;  // the zero
  }
}

Bytes WithCrc(Bytes inside) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (std::byte b : inside) {
    crc ^= std::to_integer<std::uint32_t>(b);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  crc = ~crc;
  for (unsigned i = 0; i < 4; ++i) inside.push_back(static_cast<std::byte>(crc >> (8 * i)));
  return inside;
}

Bytes RawFrame(int version, int type, int sequence, std::span<const std::byte> payload) {
  Bytes inside = MakeBytes({version, type, sequence & 0xFF, sequence >> 8});
  inside.insert(inside.end(), payload.begin(), payload.end());
  const Bytes delimiter = MakeBytes({0});
  return delimiter + CobsEncode(WithCrc(inside)) + delimiter;
}

}  // namespace facewire::wire
