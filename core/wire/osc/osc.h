#ifndef FACEWIRE_CORE_WIRE_OSC_OSC_H_
#define FACEWIRE_CORE_WIRE_OSC_OSC_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/base/result.h"

// Open Sound Control 1.0: messages of numbers and strings, alone or in a bundle. README.md here is
// the specification.
namespace facewire::wire::osc {

// Makes one packet in the caller's memory. A message that does not fit leaves the packet as it was
// before, so that it can go into the next one.
//
//   Writer packet(buffer);
//   packet.Bundle();
//   if (!packet.Message("/VMC/Ext/Blend/Val", std::string_view("A"), 0.5F)) { full }
//   Send(packet.bytes());
class Writer {
 public:
  explicit Writer(std::span<std::byte> out) noexcept : out_(out) {}

  // Begins a bundle that is meant "at once"; what follows becomes its elements. kFull;
  // kInvalidArgument when something is in the packet already.
  Result<> Bundle() noexcept;

  // Adds a message. Args are float, std::int32_t and std::string_view. kFull; kInvalidArgument: the
  // address does not begin with '/', a string contains a NUL, or there is a message already and no
  // bundle around it.
  template <class... Args>
  Result<> Message(std::string_view address, const Args&... args) noexcept {
    constexpr std::array<char, sizeof...(Args) + 1> kTypes = {',', TypeOf<Args>()...};
    const std::size_t before = size_;
    Begin(address, {kTypes.data(), kTypes.size()});
    (Put(args), ...);
    return End(before);
  }

  std::span<const std::byte> bytes() const noexcept { return out_.first(size_); }

 private:
  template <class T>
  static constexpr char TypeOf() noexcept {
    if constexpr (std::is_same_v<T, float>) return 'f';
    if constexpr (std::is_same_v<T, std::int32_t>) return 'i';
    if constexpr (std::is_same_v<T, std::string_view>) return 's';
  }
  void Begin(std::string_view address, std::string_view types) noexcept;
  Result<> End(std::size_t before) noexcept;
  void PutWord(std::uint32_t word) noexcept;
  void Put(float value) noexcept;
  void Put(std::int32_t value) noexcept { PutWord(static_cast<std::uint32_t>(value)); }
  void Put(std::string_view text) noexcept;

  std::span<std::byte> out_;
  std::size_t size_ = 0;
  bool bundle_ = false;
  Errc error_{};  // of the message that is being added; none when 0
};

}  // namespace facewire::wire::osc

#endif  // FACEWIRE_CORE_WIRE_OSC_OSC_H_
