#include "core/base/result.h"

namespace facewire {

const char* Name(Errc code) noexcept {
  switch (code) {
    case Errc::kNotReady:
      return "not ready";
    case Errc::kInvalidArgument:
      return "invalid argument";
    case Errc::kOutOfRange:
      return "out of range";
    case Errc::kFull:
      return "full";
    case Errc::kTruncated:
      return "truncated";
    case Errc::kCorrupt:
      return "corrupt";
    case Errc::kVersion:
      return "unknown version";
    case Errc::kUnsupported:
      return "unsupported";
    case Errc::kNotFound:
      return "not found";
    case Errc::kBusy:
      return "busy";
    case Errc::kPermission:
      return "permission denied";
    case Errc::kTimeout:
      return "timeout";
    case Errc::kDisconnected:
      return "disconnected";
    case Errc::kIo:
      return "input/output error";
    case Errc::kEnd:
      return "end of stream";
    case Errc::kNoFace:
      return "no face";
    case Errc::kRejected:
      return "rejected";
    case Errc::kSingular:
      return "singular";
  }
  return "unknown error";
}

}  // namespace facewire
