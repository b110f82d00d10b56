#include "core/wire/command.h"

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

}  // namespace facewire::wire
