#ifndef FACEWIRE_HAL_POSIX_RAW_MODE_H_
#define FACEWIRE_HAL_POSIX_RAW_MODE_H_

#include "core/base/result.h"

namespace facewire::hal::posix {

// Bytes pass unchanged, none is echoed and none means a signal. kUnsupported (not a terminal), kIo.
Result<> SetRaw(int fd) noexcept;

}  // namespace facewire::hal::posix

#endif  // FACEWIRE_HAL_POSIX_RAW_MODE_H_
