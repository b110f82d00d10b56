#include "hal/fake/fake_serial_port.h"

#include <algorithm>

namespace facewire::hal::fake {

void FakeSerialPort::Note(SerialEventKind kind, std::size_t bytes) noexcept {
  events_.Add({.at = clock_.Now(), .kind = kind, .bytes = bytes});
}

Result<> FakeSerialPort::Open() {
  if (open_) return {};
  if (open_failures_ > 0) {
    --open_failures_;
    Note(SerialEventKind::kOpenFailed);
    return open_fault_;
  }
  if (!plugged_) {
    Note(SerialEventKind::kOpenFailed);
    return Errc::kNotFound;
  }
  open_ = true;
  Note(SerialEventKind::kOpened);
  return {};
}

void FakeSerialPort::Close() {
  if (!open_) return;
  open_ = false;
  Note(SerialEventKind::kClosed);
}

void FakeSerialPort::Unplug() noexcept {
  plugged_ = false;
  open_ = false;
  feeds_.clear();
  incoming_.clear();
  Note(SerialEventKind::kUnplugged);
}

Result<std::size_t> FakeSerialPort::Write(std::span<const std::byte> bytes,
                                          std::chrono::milliseconds timeout) {
  if (!open_) return Errc::kDisconnected;
  const std::size_t taken = std::min(bytes.size(), room_);
  for (std::byte b : bytes.first(taken)) written_.Add(b);
  if (room_ != kUnlimited) room_ -= taken;
  if (taken > 0) Note(SerialEventKind::kWritten, taken);
  if (taken == bytes.size()) return taken;

  clock_.SleepUntil(clock_.Now() + timeout);  // for room that nobody makes
  if (taken > 0) return taken;
  Note(SerialEventKind::kWriteTimedOut);
  return Errc::kTimeout;
}

bool FakeSerialPort::Feed(std::span<const std::byte> bytes, Time at) noexcept {
  if (!plugged_ || feeds_.full() || bytes.size() > incoming_.capacity() - incoming_.size()) {
    return false;
  }
  if (bytes.empty()) return true;
  const Time previous = feeds_.empty() ? Time{} : feeds_[feeds_.size() - 1].due;
  for (std::byte b : bytes) {
    if (!incoming_.try_push(b)) return false;
  }
  return feeds_.try_push({.due = std::max({at, previous, clock_.Now()}), .bytes = bytes.size()});
}

void FakeSerialPort::DropFront(std::size_t bytes) noexcept {
  std::ranges::copy(incoming_.span().subspan(bytes), incoming_.begin());
  static_cast<void>(incoming_.try_resize(incoming_.size() - bytes));  // shrinking always succeeds
  std::size_t done = 0;
  while (bytes > 0 && bytes >= feeds_[done].bytes) bytes -= feeds_[done++].bytes;
  if (bytes > 0) feeds_[done].bytes -= bytes;
  std::ranges::copy(feeds_.span().subspan(done), feeds_.begin());
  static_cast<void>(feeds_.try_resize(feeds_.size() - done));
}

Result<std::size_t> FakeSerialPort::Read(std::span<std::byte> buffer,
                                         std::chrono::milliseconds timeout) {
  if (!open_) return Errc::kDisconnected;
  if (buffer.empty()) return Errc::kInvalidArgument;
  const Time deadline = clock_.Now() + timeout;
  if (feeds_.empty() || feeds_[0].due > deadline) {
    clock_.SleepUntil(deadline);
    return Errc::kTimeout;
  }
  clock_.SleepUntil(feeds_[0].due);
  std::size_t arrived = 0;
  const Time now = clock_.Now();
  for (const FeedEntry& feed : feeds_) arrived += feed.due <= now ? feed.bytes : 0;
  const std::size_t count = std::min(arrived, buffer.size());
  std::ranges::copy(incoming_.span().first(count), buffer.begin());
  DropFront(count);
  Note(SerialEventKind::kRead, count);
  return count;
}

}  // namespace facewire::hal::fake
