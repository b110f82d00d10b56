#include "core/wire/osc_host/line_share.h"

#include <algorithm>
#include <chrono>

namespace facewire::wire::osc_host {
namespace {

constexpr std::int64_t kByte = 1'000'000;  // of credit
// A tick of the slowest rate, and on a slow line at least a small packet.
constexpr Duration kMost = std::chrono::milliseconds(50);
constexpr std::int64_t kMostAtLeast = 256 * kByte;

}  // namespace

void LineShare::Advance(Time now) noexcept {
  const std::int64_t most = std::max(kMost.count() * bytes_per_s_, kMostAtLeast);
  const Duration passed =
      last_ ? std::clamp(Between(*last_, now), Duration::zero(), Duration(1'000'000))
            : Duration(1'000'000);
  last_ = now;
  credit_ = std::min(credit_ + passed.count() * bytes_per_s_, most);
}

void LineShare::Charge(std::size_t bytes) noexcept {
  credit_ -= static_cast<std::int64_t>(bytes) * kByte;
}

std::size_t LineShare::left() const noexcept {
  return static_cast<std::size_t>(std::max<std::int64_t>(credit_, 0) / kByte);
}

}  // namespace facewire::wire::osc_host
