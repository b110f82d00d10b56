#ifndef FACEWIRE_HAL_SERIAL_PORT_H_
#define FACEWIRE_HAL_SERIAL_PORT_H_

#include <chrono>
#include <cstddef>
#include <span>

#include "core/base/result.h"

namespace facewire::hal {

// A byte line to a host or a servo bus: raw, 8N1. Not thread-safe. Destruction closes.
// After kDisconnected the port counts as closed; Open may bring it back.
class SerialPort {
 public:
  virtual ~SerialPort() = default;

  // Opens, or reopens, the line that the port was made for. An open port stays as it is.
  // kNotFound, kBusy (somebody holds it), kPermission, kUnsupported (not a line of this kind, rate
  // impossible), kIo.
  virtual Result<> Open() = 0;

  // Writes from the front of `bytes` and returns how many were taken; fewer than all only when the
  // deadline passed after some were (a zero timeout never waits). Allocates nothing.
  // kTimeout (none were taken), kDisconnected (also when not open), kIo.
  virtual Result<std::size_t> Write(std::span<const std::byte> bytes,
                                    std::chrono::milliseconds timeout) = 0;

  // Reads what has arrived, at least one byte, into the front of `buffer`. Allocates nothing.
  // kTimeout (nothing came), kDisconnected (also when not open), kIo.
  virtual Result<std::size_t> Read(std::span<std::byte> buffer,
                                   std::chrono::milliseconds timeout) = 0;

  // Of the bytes that were written, those that the line itself has not had time for: in the
  // system's queue, not what a chip behind it has stored. 0 of a port that is not open, and of
  // lines that take no time (a pseudo-terminal, a socket), however late their reader. Allocates
  // nothing.
  virtual std::size_t Unsent() { return 0; }

  virtual void Close() = 0;
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_SERIAL_PORT_H_
