#ifndef FACEWIRE_HAL_PTY_PTY_HOST_H_
#define FACEWIRE_HAL_PTY_PTY_HOST_H_

#include <string>

#include "hal/posix/unique_fd.h"
#include "hal/serial_port.h"

namespace facewire::hal::pty {

// Makes a pseudo-terminal and is the maker's end (master) of it: another program opens
// device_path(), or the link, as if it were a serial device.
//
// The line behaves like a USB gadget's: nobody at the other end is silence, never kDisconnected.
// Write then takes nothing, throws away what an earlier reader left unread and answers kTimeout at
// the deadline, so whoever opens the device next starts with fresh bytes. A write whose reader
// leaves in the middle is cut short there. Readers may come and go.
class PtyHost final : public SerialPort {
 public:
  // With a `link`, Open makes that symbolic link to the device and Close removes it.
  explicit PtyHost(std::string link = {}) : link_(std::move(link)) {}
  PtyHost(const PtyHost&) = delete;
  PtyHost& operator=(const PtyHost&) = delete;
  ~PtyHost() override { Close(); }

  // A link that an earlier run left behind is replaced; anything else at that path is kBusy and
  // stays. kNotFound: the link's folder does not exist.
  Result<> Open() override;
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds timeout) override;
  Result<std::size_t> Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) override;
  void Close() override;

  // "/dev/pts/N" while open, otherwise empty. Open makes a new one, usually with another number.
  const std::string& device_path() const noexcept { return device_path_; }

 private:
  Result<> MakeLink(const std::string& device_path) const;
  void DropUnread() noexcept;

  std::string link_;
  std::string device_path_;
  posix::UniqueFd master_;
  bool unread_ = false;  // bytes were written since the last DropUnread
};

}  // namespace facewire::hal::pty

#endif  // FACEWIRE_HAL_PTY_PTY_HOST_H_
