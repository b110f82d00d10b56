#ifndef FACEWIRE_APP_CALIBRATION_H_
#define FACEWIRE_APP_CALIBRATION_H_

#include <optional>

#include "core/face_pose.h"
#include "core/retarget/neutral_capture.h"
#include "core/wire/message.h"

namespace facewire::app {

// Decides when the performer's neutral is taken: once by itself when there is none, and whenever a
// host asks for it.
class Calibration {
 public:
  // `capture` is configured and borrowed.
  explicit Calibration(retarget::NeutralCapture& capture) noexcept : capture_(capture) {}

  // Takes a provisional neutral as soon as a face is seen calmly, and with closed lips, for long
  // enough: nobody was asked to look neutral, and a smile can be calm. Somebody whose lips never
  // close is taken as he is after kPatience tries.
  void BeginByItself() noexcept;
  // False, with nothing changed, while another command's capture runs.
  bool Begin(const wire::Command& command) noexcept;
  void Cancel() noexcept { mode_ = Mode::kIdle; }

  static constexpr int kPatience = 10;
  // Lips further apart than this part of the distance between the outer corners of the eyes are
  // open. Measured on the inner lips: a closed mouth shows up to 0.01, an open smile 0.1 to 0.2.
  static constexpr float kClosedLips = 0.035F;

  struct Outcome {
    std::optional<wire::Command> command;  // to be acknowledged with
    wire::CommandResult result = wire::CommandResult::kOk;
    bool taken = false;  // `neutral` holds one
    retarget::Neutral neutral;
  };
  // One frame; null: no face in it. True when an outcome was written: a capture ended.
  bool Update(const FacePose* face, Outcome& outcome) noexcept;

 private:
  enum class Mode { kIdle, kByItself, kCommanded };

  retarget::NeutralCapture& capture_;
  Mode mode_ = Mode::kIdle;
  int refused_ = 0;  // calm faces with open lips
  wire::Command command_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CALIBRATION_H_
