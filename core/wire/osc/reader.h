#ifndef FACEWIRE_CORE_WIRE_OSC_READER_H_
#define FACEWIRE_CORE_WIRE_OSC_READER_H_

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/result.h"

namespace facewire::wire::osc {

// A message of a packet; borrows the packet's bytes.
struct MessageView {
  std::string_view address;
  std::string_view types;                // without the comma
  std::span<const std::byte> arguments;  // exactly as many bytes as the types stand for

  // The first argument, when it is a number ('i' or 'f').
  std::optional<float> Number() const noexcept;
};

// Reads one packet: a message, or a bundle of messages. A packet that breaks a rule anywhere has no
// messages at all, so that what damage left over of one is not obeyed in part.
//
//   auto reader = Reader::Of(packet);
//   if (!reader) { not OSC }
//   while (const auto message = reader->Next()) { use *message }
class Reader {
 public:
  // Nothing to read.
  Reader() noexcept = default;

  // Looks at the whole packet, which is borrowed. kCorrupt: a length, a string's NULs or an
  // argument does not come out even, or bytes are left over. kUnsupported: a type of OSC that is
  // not read here (an array), or a bundle inside a bundle.
  static Result<Reader> Of(std::span<const std::byte> packet) noexcept;

  // The next message; nullopt after the last.
  std::optional<MessageView> Next() noexcept;

 private:
  explicit Reader(std::span<const std::byte> rest, bool bundle) noexcept
      : rest_(rest), bundle_(bundle) {}
  Result<MessageView> Take() noexcept;

  std::span<const std::byte> rest_;
  bool bundle_ = false;
};

}  // namespace facewire::wire::osc

#endif  // FACEWIRE_CORE_WIRE_OSC_READER_H_
