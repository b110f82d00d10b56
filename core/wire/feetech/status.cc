#include "core/wire/feetech/status.h"

#include <algorithm>

#include "core/wire/feetech/packet.h"

namespace facewire::wire::feetech {

Result<> StatusReader::Expect(std::span<const std::uint8_t> ids, std::size_t parameters) noexcept {
  if (parameters > kMaxStatusParameters) return Errc::kOutOfRange;
  Forget();
  parameters_ = parameters;
  for (std::uint8_t id : ids) expected_[id] = true;
  return {};
}

void StatusReader::Forget() noexcept {
  Drop(taken_);
  taken_ = 0;
  stats_.dropped += size_;
  size_ = 0;
  expected_.reset();
}

void StatusReader::Drop(std::size_t count) noexcept {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(count),
            buffer_.begin() + static_cast<std::ptrdiff_t>(size_), buffer_.begin());
  size_ -= count;
}

StatusReader::Front StatusReader::Look() noexcept {
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint8_t>(buffer_[i]); };
  for (std::size_t i = 0; i < 2 && i < size_; ++i) {
    if (at(i) != 0xFF) return Front::kNothing;
  }
  if (size_ > 2 && !expected_[at(2)]) {
    // Only instructions go to everybody; a second look at 4 bytes keeps noise from looking like it.
    if (at(2) == kBroadcast && size_ > 4) {
      const std::uint8_t instruction = at(4);
      if (instruction == static_cast<std::uint8_t>(Instruction::kSyncRead) ||
          instruction == static_cast<std::uint8_t>(Instruction::kSyncWrite)) {
        ++stats_.instructions;
      }
      return Front::kNothing;
    }
    return at(2) == kBroadcast ? Front::kPart : Front::kNothing;
  }
  if (size_ > 3 && at(3) != parameters_ + 2) return Front::kNothing;
  const std::size_t total = kFrame + parameters_;
  if (size_ < total) return Front::kPart;
  const std::uint8_t sum = Checksum(std::span(buffer_).subspan(2, total - 3));
  return at(total - 1) == sum ? Front::kPacket : Front::kNothing;
}

Result<Status> StatusReader::Next(std::span<const std::byte>& bytes) noexcept {
  Drop(taken_);
  taken_ = 0;
  for (;;) {
    while (size_ != 0) {
      const Front front = Look();
      if (front == Front::kPart) break;
      if (front == Front::kNothing) {
        Drop(1);
        ++stats_.dropped;
        continue;
      }
      taken_ = kFrame + parameters_;
      const auto id = std::to_integer<std::uint8_t>(buffer_[2]);
      expected_[id] = false;
      ++stats_.packets;
      return Status{.id = id,
                    .errors = std::to_integer<std::uint8_t>(buffer_[4]),
                    .parameters = std::span(buffer_).subspan(5, parameters_)};
    }
    if (bytes.empty()) return Errc::kNotReady;
    buffer_[size_++] = bytes.front();
    bytes = bytes.subspan(1);
  }
}

}  // namespace facewire::wire::feetech
