#ifndef FACEWIRE_APP_CALIBRATION_H_
#define FACEWIRE_APP_CALIBRATION_H_

#include <chrono>
#include <optional>

#include "app/request.h"
#include "core/face_pose.h"
#include "core/retarget/neutral_capture.h"
#include "core/wire/message.h"

namespace facewire::app {

// Decides when the performer's neutral is taken: once by itself when there is none, and whenever
// somebody asks for it.
class Calibration {
 public:
  // `capture` is borrowed, and configured for the neutral that is taken by itself; whoever asks
  // gets retarget::kStillSecond.
  explicit Calibration(retarget::NeutralCapture& capture) noexcept
      : capture_(capture), calm_(capture.config()) {}

  // Takes a provisional neutral as soon as a face is seen calmly, and with closed lips, for long
  // enough: nobody was asked to look neutral, and a smile can be calm. Somebody whose lips never
  // close is taken as he is after kPatience tries.
  void BeginByItself() noexcept;
  // Takes the first still second within kTryFor; fails at once when the face goes. False, with
  // nothing changed, while another request's runs; the same request again changes nothing.
  bool Begin(const Request& request, Time now) noexcept;
  // Whether such a request is being worked on.
  bool requested() const noexcept { return request_.has_value(); }

  static constexpr int kPatience = 10;
  static constexpr Duration kTryFor = std::chrono::seconds(10);
  // Lips further apart than this part of the distance between the outer corners of the eyes are
  // open. Measured on the inner lips: a closed mouth shows up to 0.01, an open smile 0.1 to 0.2.
  static constexpr float kClosedLips = 0.035F;

  struct Outcome {
    std::optional<Request> request;  // to be answered with
    wire::CommandResult result = wire::CommandResult::kOk;
    float measure = 0;   // as in wire::Acknowledgement
    bool taken = false;  // `neutral` holds one
    retarget::Neutral neutral;
  };
  // One picture; null: no face in it. True when an outcome was written: a capture ended.
  bool Update(Time now, const FacePose* face, Outcome& outcome) noexcept;
  // A tick without a picture.
  bool Wait(Time now, Outcome& outcome) noexcept;

 private:
  bool UpdateByItself(const FacePose* face, Outcome& outcome) noexcept;
  bool UpdateRequested(Time now, const FacePose* face, Outcome& outcome) noexcept;
  bool EndRequest(wire::CommandResult result, Outcome& outcome) noexcept;

  retarget::NeutralCapture& capture_;
  retarget::NeutralCaptureConfig calm_;  // what is asked of a face that was not asked
  bool by_itself_ = false;               // a provisional neutral is wanted
  int refused_ = 0;                      // calm faces with open lips
  std::optional<Request> request_;       // comes first
  Time until_{};
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CALIBRATION_H_
