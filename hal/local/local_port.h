#ifndef FACEWIRE_HAL_LOCAL_LOCAL_PORT_H_
#define FACEWIRE_HAL_LOCAL_LOCAL_PORT_H_

#include <string>

#include "hal/posix/unique_fd.h"
#include "hal/serial_port.h"

namespace facewire::hal::local {

// Whether a socket's file is at `path`. kNotFound, kPermission, kIo.
Result<bool> IsSocket(const std::string& path) noexcept;

// The client's end of a local socket, as a line: Open connects to whoever listens at the path at
// that moment (kNotFound: nobody). When the server closes its end, the line is kDisconnected. Any
// number of ports may be connected to one server.
class LocalPort final : public SerialPort {
 public:
  explicit LocalPort(std::string path) : path_(std::move(path)) {}

  Result<> Open() override;
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds timeout) override;
  Result<std::size_t> Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) override;
  void Close() override { fd_.Reset(); }

 private:
  std::string path_;
  posix::UniqueFd fd_;
};

}  // namespace facewire::hal::local

#endif  // FACEWIRE_HAL_LOCAL_LOCAL_PORT_H_
