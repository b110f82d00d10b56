#include "app/answer_text.h"

#include <cstdio>

namespace facewire::app {
namespace {

using wire::CommandCode;
using wire::CommandResult;

const char* DoneText(CommandCode code) noexcept {
  switch (code) {
    case CommandCode::kCalibrateNeutral:
      return "the neutral was taken, and is kept";
    case CommandCode::kRest:
      return "easing to neutral; `facewire release` lets it follow again";
    case CommandCode::kStop:
      return "stopped, over restarts too; `facewire release` ends it";
    case CommandCode::kRelease:
      return "released";
    case CommandCode::kReload:
      return "reloaded rig, blend, filter, rates and state times; other changes need a restart";
    default:
      return "done";
  }
}

const char* RefusedText(CommandCode code) noexcept {
  switch (code) {
    case CommandCode::kCalibrateNeutral:
      return "another calibration is running; wait for its end";
    case CommandCode::kRelease:
      return "the emergency stop's line is open: unlock its switch, or mend its wire, then release";
    case CommandCode::kBlendProfile:
      return "there is no personal profile to blend in, or the part is not within 0 and 100 %";
    case CommandCode::kMoveServo:
      return "no such servo is driven by this service, or an emergency stop holds";
    case CommandCode::kLandmarks:
      return "landmarks go to the host on the line alone, of 0 to 60 pictures a second";
    case CommandCode::kReport:
    case CommandCode::kReload:
      return "only programs on the device itself may ask that, on its control socket";
    default:
      return "refused in the present state";
  }
}

const char* FailedText(CommandCode code) noexcept {
  switch (code) {
    case CommandCode::kCalibrateNeutral:
      return "the neutral could not be used";
    case CommandCode::kRelease:
      return "not released: the stop is remembered where it cannot be removed";
    case CommandCode::kReload:
      return "not reloaded, running on as before";
    default:
      return "failed";
  }
}

const char* NotKeptText(CommandCode code) noexcept {
  return code == CommandCode::kStop ? "stopped, but a restart may forget it"
                                    : "the neutral was taken, but is kept only until the restart";
}

// The measure stands where the %g is.
const char* MeasureText(CommandResult result, float measure) noexcept {
  switch (result) {
    case CommandResult::kHeadTurned:
      return "hold still: the head turned by %.0f degrees within the second";
    case CommandResult::kHeadMoved:
      return "hold still: the head moved by %.1f cm within the second";
    case CommandResult::kFaceMoved:
      return "keep the face still: it moved by %.1f cm within the second";
    case CommandResult::kEyesClosed:
      return measure < 1 ? "do not blink: an eye closed to %.2f of its way within the second"
                         : "open the eyes: they were closed";
    default:
      return "close the mouth: the lips stand apart by %.2f of its width";
  }
}

}  // namespace

std::array<char, 160> AnswerText(const wire::Acknowledgement& answer) noexcept {
  std::array<char, 160> text{};
  const char* plain = nullptr;
  switch (answer.result) {
    case CommandResult::kOk:
      plain = DoneText(answer.code);
      break;
    case CommandResult::kUnknown:
      plain = "the device does not know this command; its facewired is older";
      break;
    case CommandResult::kRefused:
      plain = RefusedText(answer.code);
      break;
    case CommandResult::kNoFace:
      plain = "no face is seen; sit before the camera and look at it";
      break;
    case CommandResult::kFailed:
      plain = FailedText(answer.code);
      break;
    case CommandResult::kNotKept:
      plain = NotKeptText(answer.code);
      break;
    default:
      break;
  }
  if (plain != nullptr) {
    (void)std::snprintf(text.data(), text.size(), "%s", plain);
  } else if (wire::HasMeasure(answer.result)) {
    (void)std::snprintf(text.data(), text.size(), MeasureText(answer.result, answer.measure),
                        static_cast<double>(answer.measure));
  } else {
    (void)std::snprintf(text.data(), text.size(), "failed, with result %d",
                        static_cast<int>(answer.result));
  }
  return text;
}

}  // namespace facewire::app
