#ifndef FACEWIRE_HAL_PTY_PTY_PORT_H_
#define FACEWIRE_HAL_PTY_PTY_PORT_H_

#include <string>

#include "hal/posix/unique_fd.h"
#include "hal/serial_port.h"

namespace facewire::hal::pty {

// Whether `path`, or what it links to, is the program's end of a pseudo-terminal (/dev/pts/N).
// kNotFound, kPermission, kIo.
Result<bool> IsPseudoTerminal(const std::string& path) noexcept;

// The program's end (slave) of a pseudo-terminal that somebody else made: a simulator, socat, a
// test, a PtyHost. Bytes pass at any bit rate; the one that is given is only noted on the line,
// where a simulated device may look at it. When the maker closes its end, the line is hung up
// (kDisconnected) and its name is gone until it is made anew; a link in its place is followed at
// every Open.
class PtyPort final : public SerialPort {
 public:
  explicit PtyPort(std::string path, int baud = 0) : path_(std::move(path)), baud_(baud) {}

  Result<> Open() override;
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds timeout) override;
  Result<std::size_t> Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) override;
  void Close() override { fd_.Reset(); }

 private:
  std::string path_;
  int baud_;  // 0: whatever is noted
  posix::UniqueFd fd_;
};

}  // namespace facewire::hal::pty

#endif  // FACEWIRE_HAL_PTY_PTY_PORT_H_
