#include "core/wire/osc/osc.h"

#include <bit>

namespace facewire::wire::osc {
namespace {

constexpr std::string_view kBundle = "#bundle";
constexpr Errc kNone{};

}  // namespace

Result<> Writer::Bundle() noexcept {
  if (size_ != 0) return Errc::kInvalidArgument;
  error_ = kNone;
  Put(kBundle);
  PutWord(0);  // the time tag that means "at once"
  PutWord(1);
  if (error_ != kNone) {
    size_ = 0;
    return error_;
  }
  bundle_ = true;
  return {};
}

void Writer::Begin(std::string_view address, std::string_view types) noexcept {
  error_ = kNone;
  if (!address.starts_with('/') || (!bundle_ && size_ != 0)) error_ = Errc::kInvalidArgument;
  if (bundle_) PutWord(0);  // the element's size, which End knows
  Put(address);
  Put(types);
}

Result<> Writer::End(std::size_t before) noexcept {
  if (error_ != kNone) {
    size_ = before;
    return error_;
  }
  if (bundle_) {
    const std::size_t end = size_;
    size_ = before;
    PutWord(static_cast<std::uint32_t>(end - before - 4));
    size_ = end;
  }
  return {};
}

void Writer::PutWord(std::uint32_t word) noexcept {
  if (error_ != kNone) return;
  if (out_.size() - size_ < 4) {
    error_ = Errc::kFull;
    return;
  }
  for (int shift = 24; shift >= 0; shift -= 8)
    out_[size_++] = static_cast<std::byte>(word >> shift);
}

void Writer::Put(float value) noexcept { PutWord(std::bit_cast<std::uint32_t>(value)); }

// At least one NUL ends a string, and more fill its last four bytes.
void Writer::Put(std::string_view text) noexcept {
  if (error_ != kNone) return;
  const std::size_t padded = (text.size() / 4 + 1) * 4;
  if (text.find('\0') != std::string_view::npos) {
    error_ = Errc::kInvalidArgument;
  } else if (out_.size() - size_ < padded) {
    error_ = Errc::kFull;
  } else {
    for (std::size_t i = 0; i < padded; ++i) {
      out_[size_++] = static_cast<std::byte>(i < text.size() ? text[i] : '\0');
    }
  }
}

}  // namespace facewire::wire::osc
