#ifndef FACEWIRE_CORE_BUS_FAULT_BITS_H_
#define FACEWIRE_CORE_BUS_FAULT_BITS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/bus/guard.h"

// A servo's error register has the bits of HardwareFault in its own order: a table of pairs
// translates both ways. What the table does not name is left out.
namespace facewire::bus {

template <class Theirs>
struct FaultPair {
  Theirs theirs;  // an enumerator of the register's own bits
  HardwareFault ours;
};

template <class Theirs, std::size_t kPairs>
constexpr HardwareFaults FaultsFrom(const std::array<FaultPair<Theirs>, kPairs>& pairs,
                                    std::uint32_t bits) noexcept {
  unsigned faults = 0;
  for (const auto& pair : pairs) {
    if ((bits & static_cast<unsigned>(pair.theirs)) != 0) faults |= Bit(pair.ours);
  }
  return static_cast<HardwareFaults>(faults);
}

template <class Theirs, std::size_t kPairs>
constexpr std::uint32_t FaultsTo(const std::array<FaultPair<Theirs>, kPairs>& pairs,
                                 HardwareFaults faults) noexcept {
  std::uint32_t bits = 0;
  for (const auto& pair : pairs) {
    if ((faults & Bit(pair.ours)) != 0) bits |= static_cast<unsigned>(pair.theirs);
  }
  return bits;
}

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_FAULT_BITS_H_
