#ifndef FACEWIRE_CORE_WIRE_CRC32_H_
#define FACEWIRE_CORE_WIRE_CRC32_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace facewire::wire {

// CRC-32/ISO-HDLC, the CRC of Ethernet, zlib and PNG: polynomial 0x04C11DB7 (0xEDB88320 reflected),
// initial value and final XOR 0xFFFFFFFF, reflected both ways; of "123456789" it is 0xCBF43926.
class Crc32 {
 public:
  constexpr void Add(std::byte byte) noexcept {
    const auto b = std::to_integer<std::uint32_t>(byte);
    register_ = kTable[(register_ ^ b) & 0x0FU] ^ (register_ >> 4U);
    register_ = kTable[(register_ ^ (b >> 4U)) & 0x0FU] ^ (register_ >> 4U);
  }
  constexpr void Add(std::span<const std::byte> bytes) noexcept {
    for (std::byte b : bytes) Add(b);
  }
  constexpr std::uint32_t value() const noexcept { return ~register_; }

 private:
  // Half a byte at a time: a table of 64 bytes, which small receivers can afford too. All of a
  // 64-channel pose, this included, takes microseconds (tests/bench/wire_bench.cc): no larger table
  // is needed.
  static constexpr std::array<std::uint32_t, 16> kTable = [] {
    std::array<std::uint32_t, 16> table{};
    for (std::uint32_t i = 0; i < 16; ++i) {
      std::uint32_t r = i;
      for (int bit = 0; bit < 4; ++bit) r = (r >> 1U) ^ ((r & 1U) != 0 ? 0xEDB88320U : 0U);
      table[i] = r;
    }
    return table;
  }();

  std::uint32_t register_ = 0xFFFFFFFFU;
};

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_CRC32_H_
