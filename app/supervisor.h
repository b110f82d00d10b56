#ifndef FACEWIRE_APP_SUPERVISOR_H_
#define FACEWIRE_APP_SUPERVISOR_H_

#include <string_view>

#include "core/base/time.h"
#include "hal/posix/unique_fd.h"

namespace facewire::app {

// Talks to systemd (sd_notify(3), "Notify protocol": datagrams to the socket that NOTIFY_SOCKET
// names). Without a supervisor every call does nothing. libsystemd is not used because it opens a
// socket for every message; here one stays open, so the running service neither allocates nor opens
// files.
class Supervisor {
 public:
  // Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  Supervisor() noexcept;

  // Half of the interval after which the watchdog bites; zero: there is no watchdog.
  Duration watchdog_interval() const noexcept { return watchdog_interval_; }

  void Ready() noexcept { Send("READY=1"); }
  void Stopping() noexcept { Send("STOPPING=1"); }
  // Followed by Ready when the reload is over, whatever came of it.
  void Reloading(Time now) noexcept;
  void Alive() noexcept { Send("WATCHDOG=1"); }
  // Shown by `systemctl status`; up to 200 characters, no line ends.
  void Status(std::string_view text) noexcept;

 private:
  void Send(std::string_view message) noexcept;

  hal::posix::UniqueFd socket_;
  Duration watchdog_interval_{};
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_SUPERVISOR_H_
