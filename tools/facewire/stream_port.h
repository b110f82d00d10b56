#ifndef FACEWIRE_TOOLS_FACEWIRE_STREAM_PORT_H_
#define FACEWIRE_TOOLS_FACEWIRE_STREAM_PORT_H_

#include <memory>
#include <string>

#include "hal/posix/unique_fd.h"
#include "hal/serial_port.h"

namespace facewire::tools {

// A recorded line: a file, a FIFO, or the standard input ("-"). It can only be read. The end is
// kEnd; a FIFO that nobody has written to yet is silent.
class StreamPort final : public hal::SerialPort {
 public:
  explicit StreamPort(std::string path) : path_(std::move(path)) {}

  Result<> Open() override;
  Result<std::size_t> Write(std::span<const std::byte>, std::chrono::milliseconds) override {
    return Errc::kUnsupported;
  }
  Result<std::size_t> Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) override;
  void Close() override { own_.Reset(); }

 private:
  std::string path_;
  hal::posix::UniqueFd own_;
  bool had_data_ = false;
};

// Whether `path` is one of these, as opposed to a line that a device is at the other end of.
bool IsStream(const std::string& path);

// What `path` stands for: one of these, or whatever app::MakeSerialPort finds there.
std::unique_ptr<hal::SerialPort> MakeLine(const std::string& path, int baud);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_STREAM_PORT_H_
