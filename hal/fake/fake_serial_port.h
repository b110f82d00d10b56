#ifndef FACEWIRE_HAL_FAKE_FAKE_SERIAL_PORT_H_
#define FACEWIRE_HAL_FAKE_FAKE_SERIAL_PORT_H_

#include <array>
#include <cstdint>
#include <limits>

#include "core/base/inline_vector.h"
#include "hal/clock.h"
#include "hal/fake/recording.h"
#include "hal/serial_port.h"

namespace facewire::hal::fake {

enum class SerialEventKind : std::uint8_t {
  kOpened,
  kOpenFailed,
  kWritten,
  kWriteTimedOut,
  kRead,
  kUnplugged,
  kClosed,
};

struct SerialEvent {
  Time at{};
  SerialEventKind kind = SerialEventKind::kOpened;
  std::size_t bytes = 0;  // kWritten, kRead
};

// A line that ends in a recording. What is written is remembered with its time; what is read was
// fed by the test; faults come on demand. Waits use the clock, so with a FakeClock they take no
// time and with the system's they are real. Fixed size (about 90 KiB), nothing allocates. Not
// thread-safe.
class FakeSerialPort final : public SerialPort {
 public:
  static constexpr std::size_t kWrittenCapacity = 65536;
  static constexpr std::size_t kIncomingCapacity = 4096;
  static constexpr std::size_t kMaxFeeds = 64;

  // `clock` is borrowed for the port's life.
  explicit FakeSerialPort(Clock& clock) noexcept : clock_(clock) {}

  Result<> Open() override;
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds timeout) override;
  Result<std::size_t> Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) override;
  void Close() override;

  // The far end sends `bytes` at `at` (not before the previous feed; a time that has passed means
  // now). False, with nothing fed, when they do not fit.
  [[nodiscard]] bool Feed(std::span<const std::byte> bytes, Time at = Time{}) noexcept;

  // The far end takes `bytes` more and then no more, like a full USB buffer: writes become partial,
  // then time out. AcceptAll ends that.
  void AcceptOnly(std::size_t bytes) noexcept { room_ = bytes; }
  void AcceptAll() noexcept { room_ = kUnlimited; }

  // Pulls the plug: unread input is lost, every call answers kDisconnected, and Open answers
  // kNotFound until Plug.
  void Unplug() noexcept;
  void Plug() noexcept { plugged_ = true; }

  // The next `times` Opens answer `fault`, plugged or not.
  void FailOpens(int times, Errc fault) noexcept {
    open_failures_ = times;
    open_fault_ = fault;
  }

  bool is_open() const noexcept { return open_; }
  const Recording<std::byte, kWrittenCapacity>& written() const noexcept { return written_; }
  const Recording<SerialEvent, 512>& events() const noexcept { return events_; }

 private:
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();
  struct FeedEntry {
    Time due{};
    std::size_t bytes = 0;
  };

  void Note(SerialEventKind kind, std::size_t bytes = 0) noexcept;
  void DropFront(std::size_t bytes) noexcept;

  Clock& clock_;
  bool open_ = false;
  bool plugged_ = true;
  int open_failures_ = 0;
  Errc open_fault_ = Errc::kIo;
  std::size_t room_ = kUnlimited;
  InlineVector<FeedEntry, kMaxFeeds> feeds_;             // in the order of arrival
  InlineVector<std::byte, kIncomingCapacity> incoming_;  // the bytes of feeds_, one after the other
  Recording<std::byte, kWrittenCapacity> written_;
  Recording<SerialEvent, 512> events_;
};

}  // namespace facewire::hal::fake

#endif  // FACEWIRE_HAL_FAKE_FAKE_SERIAL_PORT_H_
