#include "tools/facewire/stream_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "app/devices.h"

namespace facewire::tools {

Result<> StreamPort::Open() {
  if (path_ == "-" || own_) return {};
  // Not blocking: a FIFO opens before its writer comes.
  own_.Reset(open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (own_) return {};
  if (errno == ENOENT || errno == ENOTDIR) return Errc::kNotFound;
  return errno == EACCES || errno == EPERM ? Errc::kPermission : Errc::kIo;
}

Result<std::size_t> StreamPort::Read(std::span<std::byte> buffer,
                                     std::chrono::milliseconds timeout) {
  const int fd = path_ == "-" ? STDIN_FILENO : own_.get();
  if (fd < 0) return Errc::kDisconnected;
  pollfd waiting{.fd = fd, .events = POLLIN, .revents = 0};
  const int ready = poll(&waiting, 1, static_cast<int>(timeout.count()));
  if (ready == 0 || (ready < 0 && errno == EINTR)) return Errc::kTimeout;
  if (ready < 0) return Errc::kIo;
  const ssize_t count = read(fd, buffer.data(), buffer.size());
  if (count < 0) return errno == EAGAIN || errno == EINTR ? Errc::kTimeout : Errc::kIo;
  if (count == 0) {
    struct stat status {};
    const bool fifo = fstat(fd, &status) == 0 && S_ISFIFO(status.st_mode);
    return fifo && !had_data_ && path_ != "-" ? Errc::kTimeout : Errc::kEnd;
  }
  had_data_ = true;
  return static_cast<std::size_t>(count);
}

bool IsStream(const std::string& path) {
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  return path == "-" || (exists && (S_ISREG(status.st_mode) || S_ISFIFO(status.st_mode)));
}

std::unique_ptr<hal::SerialPort> MakeLine(const std::string& path, int baud) {
  if (IsStream(path)) return std::make_unique<StreamPort>(path);
  return app::MakeSerialPort(path, baud);
}

}  // namespace facewire::tools
