#include "hal/gpiod/gpiod_line.h"

#include <cerrno>

#include "hal/posix/errors.h"

namespace facewire::hal::gpiod {
namespace {

constexpr std::string_view kGone = "the GPIO chip has gone";
constexpr std::string_view kNotOpen = "the line is not open";

// Drivers inside the kernel say "not supported" with this number, which has no name outside.
constexpr int kKernelNotSupported = 524;

const char* Text(Bias bias) noexcept {
  switch (bias) {
    case Bias::kPullUp:
      return "pull it up";
    case Bias::kPullDown:
      return "pull it down";
    default:
      return "take its pull resistor off";
  }
}

}  // namespace

Result<> TakenLine::Take() {
  if (held_ != nullptr) return {};
  reason_ = {};
  const Result<Place> place = FindLine(library_, config_.name, said_);
  if (!place) {
    reason_ = said_;
    return place.error();
  }
  const LineSettings settings{.output = output_,
                              .active_low = config_.active_low,
                              .bias = output_ ? Bias::kAsIs : config_.bias};
  held_ = library_.Take(place->path, place->offset, settings);
  if (held_ != nullptr) return {};
  const Errc error = Refused(errno, *place);
  reason_ = said_;
  return error;
}

// Puts the reason into said_.
Errc TakenLine::Refused(int error, const Place& place) {
  switch (error) {
    case EBUSY:
      said_ = place.text + " is in use" +
              (place.line.consumer.empty() ? "" : " by \"" + place.line.consumer + "\"") +
              "; end that use first, or choose another line";
      return Errc::kBusy;
    case EACCES:
    case EPERM:
      said_ = place.text + ": the system forbids to take it; the user must be in the group of " +
              place.path;
      return Errc::kPermission;
    case EINVAL:
    case EOPNOTSUPP:
    case kKernelNotSupported:
      if (output_ || config_.bias == Bias::kAsIs) {
        said_ = place.text + " cannot be an " + (output_ ? "output" : "input");
      } else {
        said_ = place.text + ": the chip or its driver cannot " + Text(config_.bias) +
                "; put a resistor there, and give no bias";
      }
      return Errc::kUnsupported;
    default: {
      const Errc code = posix::DeviceError(error);
      said_ = place.text + (code == Errc::kDisconnected ? ": " + std::string(kGone)
                                                        : ": " + std::string(Name(code)));
      return code;
    }
  }
}

Errc TakenLine::Lost(int error) noexcept {
  const Errc code = posix::DeviceError(error);
  if (code != Errc::kDisconnected) {
    reason_ = Name(code);
    return Errc::kIo;
  }
  held_.reset();
  reason_ = kGone;
  return code;
}

Result<bool> TakenLine::Get() {
  if (held_ == nullptr) {
    reason_ = kNotOpen;
    return Errc::kDisconnected;
  }
  const int level = held_->Get();
  if (level < 0) return Lost(errno);
  return level > 0;
}

Result<> TakenLine::Set(bool asserted) {
  if (held_ == nullptr) {
    reason_ = kNotOpen;
    return Errc::kDisconnected;
  }
  if (held_->Set(asserted) != 0) return Lost(errno);
  return {};
}

}  // namespace facewire::hal::gpiod
