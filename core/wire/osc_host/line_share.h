#ifndef FACEWIRE_CORE_WIRE_OSC_HOST_LINE_SHARE_H_
#define FACEWIRE_CORE_WIRE_OSC_HOST_LINE_SHARE_H_

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/time.h"

namespace facewire::wire::osc_host {

// How many bytes may go to a line now, so that none of them waits behind others: what a driver
// accepts (4 KB on Linux, 350 ms at 115200 baud) says nothing about what has left. Credit grows
// with the time and never beyond what the line carries in one tick.
class LineShare {
 public:
  // 8N1: ten bits a byte. A sixteenth is kept back, because two crystals differ.
  explicit LineShare(int baud) noexcept : bytes_per_s_(std::int64_t{baud} / 10 * 15 / 16) {}

  void Advance(Time now) noexcept;
  // Bytes that were handed to the line. May leave a debt, which later time pays.
  void Charge(std::size_t bytes) noexcept;
  std::size_t left() const noexcept;

 private:
  std::int64_t bytes_per_s_;
  std::int64_t credit_ = 0;  // in millionths of a byte
  std::optional<Time> last_;
};

}  // namespace facewire::wire::osc_host

#endif  // FACEWIRE_CORE_WIRE_OSC_HOST_LINE_SHARE_H_
