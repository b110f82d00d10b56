#include "core/wire/message.h"

namespace facewire::wire {

const char* Name(ChannelKind kind) noexcept {
  switch (kind) {
    case ChannelKind::kParameter:
      return "parameter";
    case ChannelKind::kPositionX:
      return "position_x";
    case ChannelKind::kPositionY:
      return "position_y";
    case ChannelKind::kPositionZ:
      return "position_z";
    case ChannelKind::kPitch:
      return "pitch";
    case ChannelKind::kYaw:
      return "yaw";
    case ChannelKind::kRoll:
      return "roll";
  }
  return "parameter";
}

const char* Name(ReceiverState state) noexcept {
  switch (state) {
    case ReceiverState::kWaiting:
      return "waiting";
    case ReceiverState::kRamping:
      return "ramping";
    case ReceiverState::kFollowing:
      return "following";
    case ReceiverState::kHolding:
      return "holding";
    case ReceiverState::kEasing:
      return "easing";
    case ReceiverState::kResting:
      return "resting";
    case ReceiverState::kReleased:
      return "released";
    case ReceiverState::kStopped:
      return "stopped";
  }
  return "waiting";
}

}  // namespace facewire::wire
