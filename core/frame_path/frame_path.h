#ifndef FACEWIRE_CORE_FRAME_PATH_FRAME_PATH_H_
#define FACEWIRE_CORE_FRAME_PATH_FRAME_PATH_H_

#include <cstddef>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/face_pose.h"
#include "core/filter/landmark_filter.h"
#include "core/frame.h"
#include "core/landmarks.h"
#include "core/pose/pose_estimator.h"
#include "core/retarget/retargeter.h"
#include "core/rig_pose.h"
#include "core/state/state_machine.h"
#include "core/track/tracker.h"

namespace facewire {

struct FramePathConfig {
  track::TrackerConfig tracker;
  filter::FilterConfig filter;
  pose::PoseConfig pose;
};

// What a frame with a face in it came to.
struct Followed {
  Landmarks landmarks;  // filtered: what `face` was made from
  FacePose face;
  RigPose rig;  // not limited yet
};

// From a picture to the rig's wishes: the stages in their order. Read Update, and you have read the
// program.
class FramePath {
 public:
  explicit FramePath(const FramePathConfig& config) noexcept;

  // Bytes of arena that Load needs.
  static std::size_t RequiredBytes(track::Model model) noexcept {
    return track::Tracker::RequiredBytes(model);
  }
  // Errors as Tracker::Load. The arena must outlive the frame path.
  Result<> Load(const track::NetworkFiles& files, Arena& arena) noexcept;

  // Who turns faces into rig poses; borrowed. May change between frames. Before the first call
  // Update must not be called.
  void Use(retarget::Retargeter& retargeter) noexcept { retargeter_ = &retargeter; }
  // Filter settings may change between frames; the filter starts afresh.
  void Use(const filter::FilterConfig& filter) noexcept {
    filter_ = filter::LandmarkFilter(filter);
  }

  // Allocates nothing. kNoFace; kRejected (a face that cannot be right); kUnsupported (pixel
  // format).
  Result<Followed> Update(const Frame& frame) noexcept;

  // Forgets the face: the next frame is searched as a whole.
  void Reset() noexcept;

 private:
  Errc Lose(Errc why) noexcept;

  FramePathConfig config_;
  track::Tracker tracker_;
  filter::LandmarkFilter filter_;
  pose::PoseEstimator pose_;
  retarget::Retargeter* retargeter_ = nullptr;
};

// How the states see the outcome of a frame; an unusable picture is one without a face.
state::Sight SightOf(const Result<Followed>& outcome) noexcept;

}  // namespace facewire

#endif  // FACEWIRE_CORE_FRAME_PATH_FRAME_PATH_H_
