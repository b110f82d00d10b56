#include "core/wire/osc/reader.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace facewire::wire::osc {
namespace {

constexpr std::string_view kBundle("#bundle\0", 8);
constexpr std::size_t kTimeTagBytes = 8;

std::string_view TextOf(std::span<const std::byte> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t WordOf(std::span<const std::byte> bytes) noexcept {
  std::uint32_t word = 0;
  for (std::byte b : bytes.first(4)) word = word << 8U | std::to_integer<std::uint32_t>(b);
  return word;
}

// A string off the front: printable characters, then one to four NULs up to a multiple of 4.
std::optional<std::string_view> TakeString(std::span<const std::byte>& bytes) noexcept {
  const std::string_view text = TextOf(bytes);
  const std::size_t size = text.find('\0');
  if (size == std::string_view::npos) return std::nullopt;
  const std::size_t padded = (size / 4 + 1) * 4;
  if (padded > text.size()) return std::nullopt;
  const auto is_nul = [](char c) { return c == '\0'; };
  if (!std::all_of(text.begin() + size, text.begin() + padded, is_nul)) return std::nullopt;
  bytes = bytes.subspan(padded);
  return std::string_view(text.data(), size);
}

// Takes the argument of that type off the front.
Result<> Skip(char type, std::span<const std::byte>& bytes) noexcept {
  std::size_t size = 0;
  switch (type) {
    case 'T':
    case 'F':
    case 'N':
    case 'I':
      return {};
    case 's':
    case 'S':
      if (!TakeString(bytes)) return Errc::kCorrupt;
      return {};
    case 'h':
    case 'd':
    case 't':
      size = 8;
      break;
    case 'b':
      if (bytes.size() < 4) return Errc::kCorrupt;
      size = WordOf(bytes);
      if (size > bytes.size() - 4) return Errc::kCorrupt;
      size = 4 + (size + 3) / 4 * 4;
      break;
    case 'i':
    case 'f':
    case 'c':
    case 'r':
    case 'm':
      size = 4;
      break;
    default:
      return Errc::kUnsupported;
  }
  if (bytes.size() < size) return Errc::kCorrupt;
  bytes = bytes.subspan(size);
  return {};
}

Result<MessageView> MessageOf(std::span<const std::byte> bytes) noexcept {
  MessageView message;
  const auto address = TakeString(bytes);
  if (!address || !address->starts_with('/')) return Errc::kCorrupt;
  const auto types = TakeString(bytes);
  if (!types || !types->starts_with(',')) return Errc::kCorrupt;
  message.address = *address;
  message.types = *types;
  message.types.remove_prefix(1);  // the comma
  message.arguments = bytes;
  for (char type : message.types) {
    if (const Result<> skipped = Skip(type, bytes); !skipped) return skipped.error();
  }
  if (!bytes.empty()) return Errc::kCorrupt;
  return message;
}

}  // namespace

std::optional<float> MessageView::Number() const noexcept {
  if (types.empty() || (types[0] != 'i' && types[0] != 'f')) return std::nullopt;
  const std::uint32_t word = WordOf(arguments);
  return types[0] == 'f' ? std::bit_cast<float>(word)
                         : static_cast<float>(static_cast<std::int32_t>(word));
}

Result<Reader> Reader::Of(std::span<const std::byte> packet) noexcept {
  const bool bundle = TextOf(packet).starts_with(kBundle);
  if (bundle) {
    if (packet.size() < kBundle.size() + kTimeTagBytes) return Errc::kCorrupt;
    packet = packet.subspan(kBundle.size() + kTimeTagBytes);
  } else if (packet.empty()) {
    return Errc::kCorrupt;
  }
  for (Reader trial(packet, bundle); !trial.rest_.empty();) {
    if (const auto message = trial.Take(); !message) return message.error();
  }
  return Reader(packet, bundle);
}

std::optional<MessageView> Reader::Next() noexcept {
  if (rest_.empty()) return std::nullopt;
  const auto message = Take();
  if (!message) return std::nullopt;
  return *message;
}

Result<MessageView> Reader::Take() noexcept {
  std::span<const std::byte> element = rest_;
  if (bundle_) {
    if (rest_.size() < 4) return Errc::kCorrupt;
    const std::size_t size = WordOf(rest_);
    if (size > rest_.size() - 4) return Errc::kCorrupt;
    element = rest_.subspan(4, size);
    if (TextOf(element).starts_with(kBundle)) return Errc::kUnsupported;
  }
  rest_ = rest_.subspan(element.size() + (bundle_ ? 4 : 0));
  return MessageOf(element);
}

}  // namespace facewire::wire::osc
