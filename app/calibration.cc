#include "app/calibration.h"

#include <cmath>

namespace facewire::app {
namespace {

// Of MediaPipe's face mesh.
constexpr std::size_t kUpperLipInside = 13;
constexpr std::size_t kLowerLipInside = 14;
constexpr std::size_t kRightEyeOuter = 33;
constexpr std::size_t kLeftEyeOuter = 263;

float Distance(const retarget::Neutral& face, std::size_t a, std::size_t b) noexcept {
  const Point3 d = face.points_cm[a] - face.points_cm[b];
  return std::sqrt(Dot(d, d));
}

bool LipsAreOpen(const retarget::Neutral& face) noexcept {
  return Distance(face, kUpperLipInside, kLowerLipInside) >
         Calibration::kClosedLips * Distance(face, kRightEyeOuter, kLeftEyeOuter);
}

}  // namespace

void Calibration::BeginByItself() noexcept {
  mode_ = Mode::kByItself;
  refused_ = 0;
  capture_.Reset();
}

bool Calibration::Begin(const wire::Command& command) noexcept {
  if (mode_ == Mode::kCommanded) return false;
  mode_ = Mode::kCommanded;
  command_ = command;
  capture_.Reset();
  return true;
}

bool Calibration::Update(const FacePose* face, Outcome& outcome) noexcept {
  if (mode_ == Mode::kIdle) return false;
  outcome.taken = false;
  if (face == nullptr) {
    capture_.Reset();
    if (mode_ == Mode::kByItself) return false;
    outcome.result = wire::CommandResult::kNoFace;
  } else {
    capture_.Add(*face);
    if (capture_.progress() < 1) return false;
    const Result<retarget::Neutral> neutral = capture_.Finish();
    if (neutral && mode_ == Mode::kByItself && LipsAreOpen(*neutral) && ++refused_ < kPatience) {
      capture_.Reset();
      return false;
    }
    if (neutral) {
      outcome.taken = true;
      outcome.neutral = *neutral;
      outcome.result = wire::CommandResult::kOk;
    } else if (neutral.error() == Errc::kNotReady) {
      return false;
    } else {
      capture_.Reset();
      if (mode_ == Mode::kByItself) return false;  // the performer moves: once more
      outcome.result = wire::CommandResult::kFailed;
    }
  }
  outcome.command =
      mode_ == Mode::kCommanded ? std::optional<wire::Command>(command_) : std::nullopt;
  mode_ = Mode::kIdle;
  return true;
}

}  // namespace facewire::app
