#ifndef FACEWIRE_HAL_POSIX_TTY_LOCK_H_
#define FACEWIRE_HAL_POSIX_TTY_LOCK_H_

#include "core/base/result.h"

namespace facewire::hal::posix {

// Takes an open terminal for this port object alone, until the descriptor closes; kBusy when
// another port or another program that locks its terminals so (picocom, minicom, systemd) has it.
// An advisory lock, because it also holds against root, whom TIOCEXCL lets pass.
Result<> LockTty(int fd) noexcept;

}  // namespace facewire::hal::posix

#endif  // FACEWIRE_HAL_POSIX_TTY_LOCK_H_
