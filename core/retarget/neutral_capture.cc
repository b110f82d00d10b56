#include "core/retarget/neutral_capture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace facewire::retarget {
namespace {

float Median(std::span<float> values) noexcept {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Angle of the rotation between two attitudes: trace(A' B) = 1 + 2 cos.
float AngleBetween(const Matrix3& a, const Matrix3& b) noexcept {
  float trace = 0;
  for (std::size_t i = 0; i < a.size(); ++i) trace += a[i] * b[i];
  const float cosine = std::clamp((trace - 1) / 2, -1.0F, 1.0F);
  return std::acos(cosine) * 180.0F / std::numbers::pi_v<float>;
}

bool IsFinite(const FacePose& face) noexcept {
  const auto finite = [](Point3 p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  return finite(face.camera_t_head_cm) &&
         std::ranges::all_of(face.camera_R_head, [](float v) { return std::isfinite(v); }) &&
         std::ranges::all_of(std::span(face.points_cm).first(face.count), finite);
}

// A mouth that stands open is nobody's face at rest, and as a neutral it would make closed lips the
// opposite of open ones. Gap of the inner lips over the mouth's width; only in the face mesh's
// order.
constexpr float kOpenMouth = 0.2F;

bool MouthStandsOpen(const Neutral& neutral) noexcept {
  if (neutral.count < kMeshLandmarks) return false;
  const Point3 gap = neutral.points_cm[13] - neutral.points_cm[14];
  const Point3 width = neutral.points_cm[308] - neutral.points_cm[78];
  return Dot(gap, gap) > kOpenMouth * kOpenMouth * Dot(width, width);
}

}  // namespace

std::size_t NeutralCapture::RequiredBytes() noexcept {
  return kMaxNeutralFrames * sizeof(Shot) +
         std::max(kMaxNeutralFrames, kMaxLandmarks) * sizeof(float) + 2 * alignof(Shot);
}

Result<> NeutralCapture::Configure(const NeutralCaptureConfig& config, Arena& arena) noexcept {
  if (config.min_frames == 0 || config.min_frames > kMaxNeutralFrames / 2 ||
      config.duration < Duration::zero() || !(config.max_stray_cm > 0) ||
      !(config.max_turn_deg > 0))
    return Errc::kOutOfRange;
  config_ = config;
  shots_ = arena.MakeArray<Shot>(kMaxNeutralFrames);
  scratch_ = arena.MakeArray<float>(std::max(kMaxNeutralFrames, kMaxLandmarks));
  if (shots_.empty() || scratch_.empty()) return Errc::kFull;
  Reset();
  return {};
}

void NeutralCapture::Reset() noexcept {
  count_ = 0;
  points_ = 0;
  every_ = 1;
  skipped_ = 0;
}

void NeutralCapture::Add(const FacePose& face) noexcept {
  if (shots_.empty() || face.count == 0 || face.count > kMaxLandmarks || !IsFinite(face)) return;
  if (face.count != points_) Reset();
  points_ = face.count;
  if (count_ > 0 && ++skipped_ < every_) return;
  skipped_ = 0;
  if (count_ == shots_.size()) {
    for (std::size_t i = 0; 2 * i < count_; ++i) shots_[i] = shots_[2 * i];
    count_ = (count_ + 1) / 2;
    every_ *= 2;
  }
  Shot& shot = shots_[count_++];
  shot.captured = face.captured;
  shot.camera_R_head = face.camera_R_head;
  shot.camera_t_head_cm = face.camera_t_head_cm;
  shot.points_cm = face.points_cm;
}

float NeutralCapture::progress() const noexcept {
  if (count_ == 0) return 0;
  const float frames = static_cast<float>(count_ * every_) / static_cast<float>(config_.min_frames);
  const float wanted = Seconds(config_.duration);
  const float seen = Seconds(shots_[count_ - 1].captured - shots_[0].captured);
  const float time = wanted > 0 ? seen / wanted : 1.0F;
  return std::clamp(std::min(frames, time), 0.0F, 1.0F);
}

// Sum of squared distances over every fourth point: neighbours move alike.
float NeutralCapture::DistanceBetween(const Shot& a, const Shot& b) const noexcept {
  float sum = 0;
  for (std::size_t p = 0; p < points_; p += 4) {
    const Point3 d = a.points_cm[p] - b.points_cm[p];
    sum += Dot(d, d);
  }
  return sum;
}

// The shot with the least median distance to all others.
std::size_t NeutralCapture::MostTypical() noexcept {
  std::size_t best = 0;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = 0; j < count_; ++j) scratch_[j] = DistanceBetween(shots_[i], shots_[j]);
    const float median = Median(scratch_.first(count_));
    if (median >= least) continue;
    least = median;
    best = i;
  }
  return best;
}

void NeutralCapture::ChooseAlike() noexcept {
  const Shot& typical = shots_[MostTypical()];
  std::array<float, kMaxNeutralFrames> distance{};
  for (std::size_t i = 0; i < count_; ++i) {
    alike_[i] = static_cast<std::uint8_t>(i);
    distance[i] = DistanceBetween(shots_[i], typical);
  }
  const auto end = alike_.begin() + static_cast<std::ptrdiff_t>(count_);
  std::sort(alike_.begin(), end,
            [&](std::uint8_t a, std::uint8_t b) { return distance[a] < distance[b]; });
  alike_count_ = (count_ + 1) / 2;
}

float NeutralCapture::MedianOf(float Point3::*axis, std::size_t point) noexcept {
  for (std::size_t i = 0; i < alike_count_; ++i)
    scratch_[i] = shots_[alike_[i]].points_cm[point].*axis;
  return Median(scratch_.first(alike_count_));
}

float NeutralCapture::StrayOf(std::size_t point, Point3 median) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const Point3 d = shots_[i].points_cm[point] - median;
    scratch_[i] = std::sqrt(Dot(d, d));
  }
  return Median(scratch_.first(count_));
}

// The shot whose attitude has the least median angle to all others; a median for rotations.
std::size_t NeutralCapture::MedianAttitude(float& turn_deg) noexcept {
  std::size_t best = 0;
  turn_deg = 360;
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = 0; j < count_; ++j)
      scratch_[j] = AngleBetween(shots_[i].camera_R_head, shots_[j].camera_R_head);
    const float median = Median(scratch_.first(count_));
    if (median >= turn_deg) continue;
    turn_deg = median;
    best = i;
  }
  return best;
}

Result<Neutral> NeutralCapture::Finish() noexcept {
  if (progress() < 1) return Errc::kNotReady;
  ChooseAlike();
  Neutral neutral;
  neutral.count = points_;
  for (std::size_t p = 0; p < points_; ++p)
    neutral.points_cm[p] = {MedianOf(&Point3::x, p), MedianOf(&Point3::y, p),
                            MedianOf(&Point3::z, p)};
  std::size_t moving = 0;
  for (std::size_t p = 0; p < points_; ++p)
    if (StrayOf(p, neutral.points_cm[p]) > config_.max_stray_cm) ++moving;
  float turn_deg = 0;
  const std::size_t attitude = MedianAttitude(turn_deg);
  if (10 * moving > points_ || turn_deg > config_.max_turn_deg || MouthStandsOpen(neutral))
    return Errc::kRejected;
  neutral.camera_R_head = shots_[attitude].camera_R_head;
  for (float Point3::*axis : {&Point3::x, &Point3::y, &Point3::z}) {
    for (std::size_t i = 0; i < count_; ++i) scratch_[i] = shots_[i].camera_t_head_cm.*axis;
    neutral.camera_t_head_cm.*axis = Median(scratch_.first(count_));
  }
  return neutral;
}

}  // namespace facewire::retarget
