#include "tools/facewire/monitor_model.h"

#include <algorithm>

namespace facewire::tools {

void AgeHistogram::Add(std::uint32_t age_us) noexcept {
  ++buckets_[std::min<std::size_t>(age_us / 1000, buckets_.size() - 1)];
  ++count_;
}

int AgeHistogram::Quantile(double part) const noexcept {
  std::uint64_t seen = 0;
  for (std::size_t ms = 0; ms < buckets_.size(); ++ms) {
    seen += buckets_[ms];
    if (static_cast<double>(seen) >= part * static_cast<double>(count_)) {
      return static_cast<int>(ms);
    }
  }
  return 0;
}

void CaptureRate::Add(Time captured) noexcept {
  const Time last = times_[(count_ + times_.size() - 1) % times_.size()];
  if (count_ > 0 && captured == last) return;
  if (count_ > 0 && captured < last) count_ = 0;  // the device restarted
  times_[count_ % times_.size()] = captured;
  ++count_;
}

std::optional<double> CaptureRate::fps() const noexcept {
  const std::size_t kept = std::min(count_, times_.size());
  if (kept < 2) return std::nullopt;
  const Time newest = times_[(count_ - 1) % times_.size()];
  const Time oldest = times_[(count_ - kept) % times_.size()];
  return static_cast<double>(kept - 1) * 1e6 / static_cast<double>((newest - oldest).count());
}

}  // namespace facewire::tools
