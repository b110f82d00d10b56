#include "core/wire/message.h"

namespace facewire::wire {

const char* Name(CommandCode code) noexcept {
  switch (code) {
    case CommandCode::kPing:
      return "ping";
    case CommandCode::kDescribeRig:
      return "describe_rig";
    case CommandCode::kCalibrateNeutral:
      return "calibrate_neutral";
    case CommandCode::kRest:
      return "rest";
    case CommandCode::kStop:
      return "stop";
    case CommandCode::kRelease:
      return "release";
    case CommandCode::kBlendProfile:
      return "blend_profile";
    case CommandCode::kReport:
      return "report";
    case CommandCode::kReload:
      return "reload";
    case CommandCode::kMoveServo:
      return "move_servo";
    case CommandCode::kLandmarks:
      return "landmarks";
  }
  return "unknown";
}

const char* Name(CommandResult result) noexcept {
  switch (result) {
    case CommandResult::kOk:
      return "ok";
    case CommandResult::kUnknown:
      return "unknown_command";
    case CommandResult::kRefused:
      return "refused";
    case CommandResult::kNoFace:
      return "no_face";
    case CommandResult::kFailed:
      return "failed";
    case CommandResult::kHeadTurned:
      return "head_turned";
    case CommandResult::kHeadMoved:
      return "head_moved";
    case CommandResult::kFaceMoved:
      return "face_moved";
    case CommandResult::kEyesClosed:
      return "eyes_closed";
    case CommandResult::kMouthOpen:
      return "mouth_open";
    case CommandResult::kNotKept:
      return "not_kept";
  }
  return "failed";
}

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
