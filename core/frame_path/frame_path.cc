#include "core/frame_path/frame_path.h"

namespace facewire {

FramePath::FramePath(const FramePathConfig& config) noexcept
    : config_(config), filter_(config.filter), pose_(config.pose) {}

Result<> FramePath::Load(const track::NetworkFiles& files, Arena& arena) noexcept {
  return tracker_.Load(config_.tracker, files, arena);
}

// The life of a frame.
Result<Followed> FramePath::Update(const Frame& frame) noexcept {
  const Result<Landmarks> seen = tracker_.Update(frame);
  if (!seen) return Lose(seen.error());
  const Result<Landmarks> steady = filter_.Update(*seen);
  if (!steady) return Lose(steady.error());
  const Result<FacePose> face = pose_.Update(*steady);
  if (!face) return Lose(face.error());
  return Followed{*steady, *face, retargeter_->Update(*face)};
}

// A face that cannot be right may be one that the tracker follows wrongly, so it searches anew. The
// filter keeps the past then: it knows when to believe in a jump after all.
Errc FramePath::Lose(Errc why) noexcept {
  tracker_.Reset();
  if (why != Errc::kRejected) filter_.Reset();
  return why;
}

void FramePath::Reset() noexcept {
  tracker_.Reset();
  filter_.Reset();
}

state::Sight SightOf(const Result<Followed>& outcome) noexcept {
  if (outcome) return state::Sight::kFace;
  return outcome.error() == Errc::kRejected ? state::Sight::kRejected : state::Sight::kNoFace;
}

}  // namespace facewire
