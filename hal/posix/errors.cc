#include "hal/posix/errors.h"

#include <cerrno>

namespace facewire::hal::posix {

Errc OpenError(int error) noexcept {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
    case ENODEV:
    case ENXIO:
      return Errc::kNotFound;
    case EACCES:
    case EPERM:
      return Errc::kPermission;
    case EBUSY:
    case EAGAIN:
      return Errc::kBusy;
    case EISDIR:
    case ENOTTY:
    case EINVAL:
      return Errc::kUnsupported;
    default:
      return Errc::kIo;
  }
}

Errc DeviceError(int error) noexcept {
  switch (error) {
    case EIO:  // a terminal after its hang-up, a USB serial adapter after its removal
    case ENXIO:
    case ENODEV:
    case EPIPE:
    case ESHUTDOWN:
      return Errc::kDisconnected;
    case EBUSY:
      return Errc::kBusy;
    case EACCES:
    case EPERM:
      return Errc::kPermission;
    default:
      return Errc::kIo;
  }
}

}  // namespace facewire::hal::posix
