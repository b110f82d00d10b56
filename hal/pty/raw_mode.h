#ifndef FACEWIRE_HAL_PTY_RAW_MODE_H_
#define FACEWIRE_HAL_PTY_RAW_MODE_H_

#include "core/base/result.h"

namespace facewire::hal::pty {

// Bytes pass unchanged, none is echoed and none means a signal. kUnsupported (not a terminal), kIo.
Result<> SetRaw(int fd) noexcept;

}  // namespace facewire::hal::pty

#endif  // FACEWIRE_HAL_PTY_RAW_MODE_H_
