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

// How long the face has to be seen before there is a neutral, in how many frames at least, and how
// still it has to be.
struct NeutralCaptureConfig {
  Duration duration = std::chrono::seconds(2);
  std::size_t min_frames = 24;  // 1..kMaxNeutralFrames / 2
  // The part of the frames that has to be within the limits below: 0.5 is "typically" (a blink or a
  // single word is none), 1 is "always". 0..1.
  float still_part = 0.5F;
  float max_turn_deg = 10.0F;  // of the head from its median attitude
  float max_shift_cm = 1e6F;   // of the head from its median place
  float max_stray_cm = 0.25F;  // of more than a tenth of the points from their own median
  float max_closing = 1.0F;    // of either eye, see Unrest; 1: no limit
  float max_mouth_gap = 0.2F;  // of the inner lips in the neutral, as a part of the mouth's width
};
// For somebody who was told to look neutral: one second without a blink. On real and rendered
// footage, still seconds show up to 1.5 degrees, 0.5 cm, 0.15 cm and 0.15; a blink closes by 0.35
// to 0.9, and talking moves the face by 0.25 cm and more.
inline constexpr NeutralCaptureConfig kStillSecond = {.duration = std::chrono::seconds(1),
                                                      .min_frames = 8,
                                                      .still_part = 1,
                                                      .max_turn_deg = 3,
                                                      .max_shift_cm = 1,
                                                      .max_stray_cm = 0.2F,
                                                      .max_closing = 0.3F};

// Why a window of time gave no neutral.
struct Unrest {
  enum class Kind : std::uint8_t {
    kNone,
    kHeadTurned,
    kHeadMoved,
    kFaceMoved,
    kEyesClosed,
    kMouthOpen
  };
  Kind kind = Kind::kNone;
  // The number that is above its limit: degrees; cm; cm; how far an eye closed, 0..1, of its own
  // median opening (so lids that always hang are at rest; 1 too for eyes that were never open);
  // part of the mouth's width.
  float measure = 0;
};

// Finds a performer's neutral face in a window of time: first the half of the frames that are most
// alike, then the median of each coordinate over them. So neither blinks nor a word spoken inside
// the window matter. When its memory is full it keeps every second frame and takes frames half as
// often, so any duration and frame rate fit. Lids and lips are looked at only in the face mesh's
// order of points.
class NeutralCapture {
 public:
  static std::size_t RequiredBytes() noexcept;

  // kFull: the arena is too small. Otherwise as Use.
  Result<> Configure(const NeutralCaptureConfig& config, Arena& arena) noexcept;
  // Starts over, by these rules. kOutOfRange, with nothing changed: a number outside its range, or
  // a limit that is not positive.
  Result<> Use(const NeutralCaptureConfig& config) noexcept;
  const NeutralCaptureConfig& config() const noexcept { return config_; }

  void Reset() noexcept;
  // Forgets all but the newest half of the window, so that the next one overlaps with it.
  void Slide() noexcept;

  // A face with another number of points than the first one starts over.
  void Add(const FacePose& face) noexcept;

  // kNotReady: not seen for long enough yet. kRejected: not still enough, see unrest(); Reset or
  // Slide, and try again. About 10 ms of work with full memory: not for every frame.
  Result<Neutral> Finish() noexcept;
  // Of the last Finish.
  const Unrest& unrest() const noexcept { return unrest_; }

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
  float StrayOfATenth(const Neutral& neutral) noexcept;
  float ShiftFrom(Point3 median) noexcept;
  float ClosingOf(std::size_t eye) noexcept;
  std::size_t MedianAttitude(float& turn_deg) noexcept;
  bool Exceeds(Unrest::Kind kind, float measure, float limit) noexcept;

  NeutralCaptureConfig config_;
  Unrest unrest_;
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
