#ifndef FACEWIRE_CORE_RETARGET_NEUTRAL_CAPTURE_H_
#define FACEWIRE_CORE_RETARGET_NEUTRAL_CAPTURE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/face_pose.h"
#include "core/retarget/neutral.h"

namespace facewire::retarget {

struct NeutralCaptureConfig {
  // How long the face has to be seen before there is a neutral; and in at least how many frames.
  Duration duration = std::chrono::seconds(2);
  std::size_t min_frames = 24;
  // Refused when more than a tenth of the points typically (median absolute deviation) stray
  // further than this from their own median, cm. Blinks and single words do not; talking or
  // grimacing does.
  float max_stray_cm = 0.25F;
  // Refused when the head typically strays further than this from its median attitude, degrees.
  float max_turn_deg = 10.0F;
};

// Finds a performer's neutral face in a window of time: first the half of the frames that are most
// alike, then the median of each coordinate over them. So neither blinks nor a word spoken inside
// the window matter. When its memory is full it keeps every second frame and takes frames half as
// often, so any duration and frame rate fit.
class NeutralCapture {
 public:
  static std::size_t RequiredBytes() noexcept;

  // kFull: the arena is too small. kOutOfRange: min_frames is 0 or above kMaxNeutralFrames / 2, or
  // a limit is not positive.
  Result<> Configure(const NeutralCaptureConfig& config, Arena& arena) noexcept;

  void Reset() noexcept;

  // A face with another number of points than the first one starts over.
  void Add(const FacePose& face) noexcept;

  // kNotReady: not seen for long enough yet. kRejected: the face moved too much; Reset and try
  // again. About 10 ms of work with full memory: not for every frame.
  Result<Neutral> Finish() noexcept;

  // Part of the window that has been seen, 0..1.
  float progress() const noexcept;

 private:
  struct Shot {
    Time captured{};
    Matrix3 camera_R_head = kIdentity3;
    Point3 camera_t_head_cm{};
    std::array<Point3, kMaxLandmarks> points_cm{};
  };
  float DistanceBetween(const Shot& a, const Shot& b) const noexcept;
  std::size_t MostTypical() noexcept;
  void ChooseAlike() noexcept;
  float MedianOf(float Point3::*axis, std::size_t point) noexcept;
  float StrayOf(std::size_t point, Point3 median) noexcept;
  std::size_t MedianAttitude(float& turn_deg) noexcept;

  NeutralCaptureConfig config_;
  std::span<Shot> shots_;     // kMaxNeutralFrames
  std::span<float> scratch_;  // the larger of kMaxNeutralFrames and kMaxLandmarks
  std::array<std::uint8_t, kMaxNeutralFrames>
      alike_{};  // the half of the shots that are most alike
  std::size_t alike_count_ = 0;
  std::size_t count_ = 0;   // shots
  std::size_t points_ = 0;  // of each shot
  std::size_t every_ = 1;   // takes one of so many frames
  std::size_t skipped_ = 0;
  static_assert(kMaxNeutralFrames <= 256, "alike_ counts in bytes");
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_NEUTRAL_CAPTURE_H_
