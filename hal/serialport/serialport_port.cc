#include "hal/serialport/serialport_port.h"

#include <fcntl.h>
#include <libserialport.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <string_view>

#include "hal/posix/byte_stream.h"
#include "hal/posix/errors.h"
#include "hal/posix/raw_mode.h"
#include "hal/posix/tty_lock.h"

namespace facewire::hal::serialport {
namespace {

// libserialport reports a failed call of the system in errno, and everything that it refuses
// itself, such as a name without a device under /sys/class/tty, as an argument.
Errc OpenErrorOf(sp_return result) noexcept {
  switch (result) {
    case SP_ERR_FAIL:
      // A UART that the board describes but does not have answers EIO to its settings.
      return sp_last_error_code() == EIO ? Errc::kUnsupported
                                         : posix::OpenError(sp_last_error_code());
    case SP_ERR_ARG:
    case SP_ERR_SUPP:
      return Errc::kUnsupported;
    default:
      return Errc::kIo;
  }
}

// A UART still reads what is this much too fast or too slow: half a bit over the ten bits of a
// byte.
constexpr double kRateTolerance = 0.05;

// What the driver made of the bit rate: many clamp a rate that they cannot do instead of refusing
// it.
bool RateIs(sp_port* port, int baud) noexcept {
  sp_port_config* config = nullptr;
  if (sp_new_config(&config) != SP_OK) return false;
  int actual = 0;
  const bool known =
      sp_get_config(port, config) == SP_OK && sp_get_config_baudrate(config, &actual) == SP_OK;
  sp_free_config(config);
  return known && std::abs(actual - baud) <= kRateTolerance * baud;
}

// 8N1, nothing between the program and the wire.
sp_return Configure(sp_port* port, int baud) noexcept {
  for (const sp_return step :
       {sp_set_baudrate(port, baud), sp_set_bits(port, 8), sp_set_parity(port, SP_PARITY_NONE),
        sp_set_stopbits(port, 1), sp_set_flowcontrol(port, SP_FLOWCONTROL_NONE)}) {
    if (step != SP_OK) return step;
  }
  return SP_OK;
}

// The kernel's fixed name for a serial line of a USB gadget
// (drivers/usb/gadget/function/u_serial.c).
bool IsGadget(std::string_view device) noexcept { return device.starts_with("/dev/ttyGS"); }

Result<> KeepOthersOut(int fd) noexcept {
  if (Result<> locked = posix::LockTty(fd); !locked) return locked;
  // Keeps out programs that do not lock; the kernel forgets it at the last close.
  return ::ioctl(fd, TIOCEXCL) == 0 ? Result<>{} : Errc::kIo;
}

}  // namespace

void SerialportPort::ClosePort::operator()(sp_port* port) const noexcept {
  sp_close(port);  // of one that is not open: refused, and nothing happens
  sp_free_port(port);
}

SerialportPort::SerialportPort(SerialportConfig config) : config_(std::move(config)) {}

SerialportPort::~SerialportPort() { SerialportPort::Close(); }

Result<> SerialportPort::Open() {
  if (fd_ >= 0) return {};
  std::array<char, PATH_MAX> device;
  if (::realpath(config_.path.c_str(), device.data()) == nullptr) return posix::OpenError(errno);
  struct stat node {};
  if (::stat(device.data(), &node) != 0) return posix::OpenError(errno);
  if (!S_ISCHR(node.st_mode)) return Errc::kUnsupported;
  return IsGadget(device.data()) ? OpenGadget(device.data()) : OpenThroughLibrary(device.data());
}

Result<> SerialportPort::OpenThroughLibrary(const char* device) {
  sp_port* named = nullptr;
  if (const sp_return found = sp_get_port_by_name(device, &named); found != SP_OK) {
    return OpenErrorOf(found);
  }
  std::unique_ptr<sp_port, ClosePort> port(named);
  if (const sp_return opened = sp_open(named, SP_MODE_READ_WRITE); opened != SP_OK) {
    return OpenErrorOf(opened);
  }
  int fd = -1;
  if (sp_get_port_handle(named, &fd) != SP_OK) return Errc::kIo;
  if (Result<> alone = KeepOthersOut(fd); !alone) return alone;
  if (const sp_return configured = Configure(named, config_.baud); configured != SP_OK) {
    return OpenErrorOf(configured);
  }
  if (!RateIs(named, config_.baud)) return Errc::kUnsupported;
  port_ = std::move(port);
  fd_ = fd;
  return {};
}

// What libserialport 0.1.1 opens it first asks for its modem-control lines (TIOCMGET), and it gives
// up when there are none. The gadget's driver has none, and no bit rate either: bytes go at USB's
// speed.
Result<> SerialportPort::OpenGadget(const char* device) {
  posix::UniqueFd fd;
  do {
    fd.Reset(::open(device, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  } while (!fd && errno == EINTR);
  if (!fd) return posix::OpenError(errno);
  if (Result<> alone = KeepOthersOut(fd.get()); !alone) return alone;
  if (Result<> raw = posix::SetRaw(fd.get()); !raw) return raw;
  gadget_ = std::move(fd);
  fd_ = gadget_.get();
  return {};
}

void SerialportPort::Close() {
  // The kernel holds a close up for as long as half a minute while output waits for a far end that
  // takes none. A line that flows is left to send its last bytes, which bring the rig to rest.
  if (fd_ >= 0 && stalled_) ::tcflush(fd_, TCOFLUSH);
  port_.reset();
  gadget_.Reset();
  fd_ = -1;
  stalled_ = false;
}

Result<std::size_t> SerialportPort::Write(std::span<const std::byte> bytes,
                                          std::chrono::milliseconds timeout) {
  if (fd_ < 0) return Errc::kDisconnected;
  Result<std::size_t> count = posix::WriteFor(fd_, bytes, timeout);
  stalled_ = !count || *count < bytes.size();
  if (!count && count.error() == Errc::kDisconnected) Close();
  return count;
}

Result<std::size_t> SerialportPort::Read(std::span<std::byte> buffer,
                                         std::chrono::milliseconds timeout) {
  if (fd_ < 0) return Errc::kDisconnected;
  Result<std::size_t> count = posix::ReadFor(fd_, buffer, timeout);
  if (!count && count.error() == Errc::kDisconnected) Close();
  return count;
}

}  // namespace facewire::hal::serialport
