#ifndef FACEWIRE_CORE_BASE_RESULT_H_
#define FACEWIRE_CORE_BASE_RESULT_H_

#include <cstdint>
#include <tl/expected.hpp>

namespace facewire {

// Why a call did not give its result. One byte, no text: the caller that talks to a person (app,
// tools) adds what was being done and what would be right.
enum class Errc : std::uint8_t {
  kNotReady = 1,     // nothing yet: ask again later (no data on the line, first sample outstanding)
  kInvalidArgument,  // a value that no caller may pass
  kOutOfRange,       // a number outside its documented range
  kFull,             // a fixed capacity is used up
  kTruncated,        // the data ends too early
  kCorrupt,          // the data contradicts itself (checksum, structure)
  kVersion,          // the data is of a version that this program does not read
  kUnsupported,      // well-formed, but not something this program or device can do
  kNotFound,         // no such file, device, name
  kBusy,             // somebody else holds the device
  kPermission,       // the system forbids it
  kTimeout,          // the deadline passed
  kDisconnected,     // the device or the other side has gone; reopening may bring it back
  kIo,               // any other failure of a device or the system
  kEnd,              // regular end of a stream
  kNoFace,           // there is no face in the frame
  kRejected,         // a measurement that cannot be right (jump, collapse)
  kSingular,         // a linear system without a unique solution
};

// A stable lower-case name for logs and messages, such as "timeout".
const char* Name(Errc code) noexcept;

// Either a T or an Errc. [[nodiscard]], which tl::expected itself is not.
template <class T = void>
class [[nodiscard]] Result : public tl::expected<T, Errc> {
 public:
  using tl::expected<T, Errc>::expected;
  Result(Errc code) noexcept  // NOLINT(google-explicit-constructor): `return Errc::kFull;`
      : tl::expected<T, Errc>(tl::unexpect, code) {}
};

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_RESULT_H_
