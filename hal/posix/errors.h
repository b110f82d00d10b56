#ifndef FACEWIRE_HAL_POSIX_ERRORS_H_
#define FACEWIRE_HAL_POSIX_ERRORS_H_

#include "core/base/result.h"

namespace facewire::hal::posix {

// What the errno of a failed open means to the caller of hal: kNotFound (no such node, or a node
// whose device has gone), kPermission, kBusy, kUnsupported (a directory, for instance), kIo.
Errc OpenError(int error) noexcept;

// The same for a call on an open device: kDisconnected for everything a kernel driver answers once
// its device has been pulled out or the other side of a terminal has closed, kBusy, kPermission,
// kIo.
Errc DeviceError(int error) noexcept;

}  // namespace facewire::hal::posix

#endif  // FACEWIRE_HAL_POSIX_ERRORS_H_
