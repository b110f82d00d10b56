#ifndef FACEWIRE_TESTS_DEVICES_GADGET_H_
#define FACEWIRE_TESTS_DEVICES_GADGET_H_

#include <fcntl.h>

#include <filesystem>

#include "hal/posix/unique_fd.h"
#include "tests/devices/sysfs.h"

// A USB serial gadget and the computer it is plugged into, both on this machine: dummy_hcd is the
// cable between g_serial's /dev/ttyGS0 and cdc_acm's /dev/ttyACM0.
namespace facewire::devices {

inline constexpr const char* kHostTty = "/dev/ttyACM0";   // the computer's; goes with the cable
inline constexpr const char* kGadgetTty = "/dev/ttyGS0";  // the board's; stays

// The computer's port switched off and on: both ends notice as if the cable were pulled. (The
// gadget's own soft_connect does not come back on kernel 6.1: it leaves its callbacks off.)
inline constexpr const char* kPortOff = "/sys/bus/usb/devices/usb1/1-0:1.0/usb1-port1/disable";

inline void PullCable() {
  Tell(kPortOff, "1");
  WaitUntil("the computer's tty to go", [] { return !std::filesystem::exists(kHostTty); });
}

inline void PlugCable() {
  Tell(kPortOff, "0");
  // The node is there a moment before its driver lets anybody in.
  WaitUntil("the computer's tty", [] {
    return static_cast<bool>(
        hal::posix::UniqueFd(::open(kHostTty, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)));
  });
}

}  // namespace facewire::devices

#endif  // FACEWIRE_TESTS_DEVICES_GADGET_H_
