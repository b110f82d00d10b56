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

wire::CommandResult ResultOf(retarget::Unrest::Kind kind) noexcept {
  using Kind = retarget::Unrest::Kind;
  switch (kind) {
    case Kind::kHeadTurned:
      return wire::CommandResult::kHeadTurned;
    case Kind::kHeadMoved:
      return wire::CommandResult::kHeadMoved;
    case Kind::kFaceMoved:
      return wire::CommandResult::kFaceMoved;
    case Kind::kEyesClosed:
      return wire::CommandResult::kEyesClosed;
    case Kind::kMouthOpen:
      return wire::CommandResult::kMouthOpen;
    case Kind::kNone:
      break;
  }
  return wire::CommandResult::kNoFace;  // not even a second of it was seen
}

}  // namespace

void Calibration::BeginByItself() noexcept {
  by_itself_ = true;
  refused_ = 0;
  if (!request_) (void)capture_.Use(calm_);  // it was in use before
}

bool Calibration::Begin(const Request& request, Time now) noexcept {
  if (request_) {
    return request_->asker == request.asker && request_->command.id == request.command.id;
  }
  request_ = request;
  until_ = now + kTryFor;
  (void)capture_.Use(retarget::kStillSecond);  // a constant that is within its range
  return true;
}

bool Calibration::Update(Time now, const FacePose* face, Outcome& outcome) noexcept {
  if (request_) return UpdateRequested(now, face, outcome);
  return by_itself_ && UpdateByItself(face, outcome);
}

bool Calibration::Wait(Time now, Outcome& outcome) noexcept {
  return request_ && now >= until_ && EndRequest(ResultOf(capture_.unrest().kind), outcome);
}

bool Calibration::UpdateByItself(const FacePose* face, Outcome& outcome) noexcept {
  if (face == nullptr) {
    capture_.Reset();
    return false;
  }
  capture_.Add(*face);
  if (capture_.progress() < 1) return false;
  const Result<retarget::Neutral> neutral = capture_.Finish();
  if (!neutral || (LipsAreOpen(*neutral) && ++refused_ < kPatience)) {
    capture_.Reset();  // the performer moves, or does not look neutral: once more
    return false;
  }
  outcome.request.reset();
  outcome.result = wire::CommandResult::kOk;
  outcome.taken = true;
  outcome.neutral = *neutral;
  by_itself_ = false;
  return true;
}

bool Calibration::UpdateRequested(Time now, const FacePose* face, Outcome& outcome) noexcept {
  if (face == nullptr) return EndRequest(wire::CommandResult::kNoFace, outcome);
  capture_.Add(*face);
  if (capture_.progress() < 1) return Wait(now, outcome);
  const Result<retarget::Neutral> neutral = capture_.Finish();
  if (!neutral) {
    capture_.Slide();
    return Wait(now, outcome);
  }
  outcome.neutral = *neutral;
  by_itself_ = false;
  return EndRequest(wire::CommandResult::kOk, outcome);
}

bool Calibration::EndRequest(wire::CommandResult result, Outcome& outcome) noexcept {
  outcome.request = request_;
  outcome.result = result;
  outcome.measure = capture_.unrest().measure;
  outcome.taken = result == wire::CommandResult::kOk;
  request_.reset();
  if (by_itself_) BeginByItself();  // its window was lost to the request
  return true;
}

}  // namespace facewire::app
