#ifndef FACEWIRE_HAL_SERIALPORT_SERIALPORT_PORT_H_
#define FACEWIRE_HAL_SERIALPORT_SERIALPORT_PORT_H_

#include <memory>
#include <string>

#include "hal/posix/byte_stream.h"
#include "hal/posix/unique_fd.h"
#include "hal/serial_port.h"

struct sp_port;  // libserialport's; its header stays in the source file

namespace facewire::hal::serialport {

struct SerialportConfig {
  std::string path;  // "/dev/ttyUSB0", or any link to it such as those of /dev/serial/by-id
  int baud = 115200;
};

// A real serial line (UART, USB adapter, USB gadget) through libserialport: 8N1, no flow control,
// raw, any bit rate the driver accepts. Nobody else can open the line meanwhile.
//
// The one exception is a USB gadget's own end (ttyGS), which libserialport cannot open: see
// OpenGadget.
//
// libserialport looks the device up, opens it and sets the rate; it does not carry the bytes: in
// 0.1.1 its waits run on the calendar's clock and its read spins on a line that was hung up.
class SerialportPort final : public SerialPort {
 public:
  explicit SerialportPort(SerialportConfig config);
  ~SerialportPort() override;

  // A link is followed at every Open, because a device that was replugged may have another name.
  // kUnsupported: not a serial device (a file, a pseudo-terminal: that is PtyPort's), or its driver
  // cannot do the bit rate to within 5 %.
  Result<> Open() override;
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds timeout) override;
  Result<std::size_t> Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) override;
  std::size_t Unsent() override { return posix::UnsentOf(fd_); }
  void Close() override;

 private:
  struct ClosePort {
    void operator()(sp_port* port) const noexcept;
  };

  Result<> OpenThroughLibrary(const char* device);
  Result<> OpenGadget(const char* device);

  SerialportConfig config_;
  // One of them while the line is open, and fd_ is its descriptor; none, and -1, otherwise.
  std::unique_ptr<sp_port, ClosePort> port_;
  posix::UniqueFd gadget_;
  int fd_ = -1;
  bool stalled_ = false;  // the last write was cut short by its deadline
};

}  // namespace facewire::hal::serialport

#endif  // FACEWIRE_HAL_SERIALPORT_SERIALPORT_PORT_H_
