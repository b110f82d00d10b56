#include "core/retarget/neutral_capture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace facewire::retarget {
namespace {

// The value that `part` (0..1) of all do not exceed.
float Quantile(std::span<float> values, float part) noexcept {
  const auto rank = static_cast<std::size_t>(part * static_cast<float>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}
float Median(std::span<float> values) noexcept { return Quantile(values, 0.5F); }

float Distance(Point3 a, Point3 b) noexcept { return std::sqrt(Dot(a - b, a - b)); }

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

// In the face mesh's order.
struct Eye {
  std::size_t upper, lower, outer, inner;
};
constexpr std::array<Eye, 2> kEyes = {{{159, 145, 33, 133}, {386, 374, 263, 362}}};
// Lids less than this part of the eye's width apart are closed; the tracker shows 0.04 to 0.1 then.
constexpr float kClosedEye = 0.1F;

// A mouth that stands open is nobody's face at rest, and as a neutral it would make closed lips the
// opposite of open ones. Gap of the inner lips over the mouth's width.
float MouthGap(const Neutral& neutral) noexcept {
  if (neutral.count < kMeshLandmarks) return 0;
  const float width = Distance(neutral.points_cm[308], neutral.points_cm[78]);
  return width > 0 ? Distance(neutral.points_cm[13], neutral.points_cm[14]) / width : 0;
}

bool IsUsable(const NeutralCaptureConfig& c) noexcept {
  return c.min_frames > 0 && c.min_frames <= kMaxNeutralFrames / 2 &&
         c.duration >= Duration::zero() && c.still_part >= 0 && c.still_part <= 1 &&
         c.max_turn_deg > 0 && c.max_shift_cm > 0 && c.max_stray_cm > 0 && c.max_closing > 0 &&
         c.max_mouth_gap > 0;
}

}  // namespace

std::size_t NeutralCapture::RequiredBytes() noexcept {
  return kMaxNeutralFrames * sizeof(Shot) +
         std::max(kMaxNeutralFrames, kMaxLandmarks) * sizeof(float) + 2 * alignof(Shot);
}

Result<> NeutralCapture::Configure(const NeutralCaptureConfig& config, Arena& arena) noexcept {
  if (!IsUsable(config)) return Errc::kOutOfRange;
  shots_ = arena.MakeArray<Shot>(kMaxNeutralFrames);
  scratch_ = arena.MakeArray<float>(std::max(kMaxNeutralFrames, kMaxLandmarks));
  if (shots_.empty() || scratch_.empty()) return Errc::kFull;
  return Use(config);
}

Result<> NeutralCapture::Use(const NeutralCaptureConfig& config) noexcept {
  if (!IsUsable(config)) return Errc::kOutOfRange;
  config_ = config;
  unrest_ = {};
  Reset();
  return {};
}

void NeutralCapture::Reset() noexcept {
  count_ = 0;
  points_ = 0;
  every_ = 1;
  skipped_ = 0;
}

void NeutralCapture::Slide() noexcept {
  if (count_ == 0) return;
  const Time from = shots_[count_ - 1].captured - config_.duration / 2;
  const auto kept = shots_.first(count_);
  const auto first = std::ranges::find_if(kept, [&](const Shot& s) { return s.captured >= from; });
  std::move(first, kept.end(), kept.begin());
  count_ = static_cast<std::size_t>(kept.end() - first);
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
  for (std::size_t i = 0; i < count_; ++i)
    scratch_[i] = Distance(shots_[i].points_cm[point], median);
  return Quantile(scratch_.first(count_), config_.still_part);
}

// How far a tenth of the points stray, or further.
float NeutralCapture::StrayOfATenth(const Neutral& neutral) noexcept {
  std::array<float, kMaxLandmarks> strays{};
  for (std::size_t p = 0; p < points_; ++p) strays[p] = StrayOf(p, neutral.points_cm[p]);
  const auto tenth = strays.begin() + static_cast<std::ptrdiff_t>(points_ / 10);
  std::nth_element(strays.begin(), tenth, strays.begin() + static_cast<std::ptrdiff_t>(points_),
                   std::greater<>());
  return *tenth;
}

float NeutralCapture::ShiftFrom(Point3 median) noexcept {
  for (std::size_t i = 0; i < count_; ++i)
    scratch_[i] = Distance(shots_[i].camera_t_head_cm, median);
  return Quantile(scratch_.first(count_), config_.still_part);
}

// How far the eye opened and closed, 0..1, against its own median: a blink shows in both directions
// when it takes more than half of the window.
float NeutralCapture::ClosingOf(std::size_t which) noexcept {
  if (points_ < kMeshLandmarks) return 0;
  const Eye& eye = kEyes[which];
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& p = shots_[i].points_cm;
    const float width = Distance(p[eye.outer], p[eye.inner]);
    scratch_[i] = width > 0 ? Distance(p[eye.upper], p[eye.lower]) / width : 0;
  }
  const auto openings = scratch_.first(count_);
  const float usual = Median(openings);
  if (usual < kClosedEye) return 1;
  const float least = Quantile(openings, 1 - config_.still_part);
  const float most = Quantile(openings, config_.still_part);
  return 1 - std::min(least / usual, usual / most);
}

// The shot whose attitude has the least typical angle to all others; a median for rotations.
std::size_t NeutralCapture::MedianAttitude(float& turn_deg) noexcept {
  std::size_t best = 0;
  turn_deg = 360;
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = 0; j < count_; ++j)
      scratch_[j] = AngleBetween(shots_[i].camera_R_head, shots_[j].camera_R_head);
    const float turn = Quantile(scratch_.first(count_), config_.still_part);
    if (turn >= turn_deg) continue;
    turn_deg = turn;
    best = i;
  }
  return best;
}

bool NeutralCapture::Exceeds(Unrest::Kind kind, float measure, float limit) noexcept {
  if (measure <= limit) return false;
  unrest_ = {.kind = kind, .measure = measure};
  return true;
}

Result<Neutral> NeutralCapture::Finish() noexcept {
  if (progress() < 1) return Errc::kNotReady;
  using Kind = Unrest::Kind;
  unrest_ = {};
  Neutral neutral;
  neutral.count = points_;
  float turn_deg = 0;
  neutral.camera_R_head = shots_[MedianAttitude(turn_deg)].camera_R_head;
  for (float Point3::*axis : {&Point3::x, &Point3::y, &Point3::z}) {
    for (std::size_t i = 0; i < count_; ++i) scratch_[i] = shots_[i].camera_t_head_cm.*axis;
    neutral.camera_t_head_cm.*axis = Median(scratch_.first(count_));
  }
  if (Exceeds(Kind::kHeadTurned, turn_deg, config_.max_turn_deg) ||
      Exceeds(Kind::kHeadMoved, ShiftFrom(neutral.camera_t_head_cm), config_.max_shift_cm))
    return Errc::kRejected;
  for (std::size_t eye = 0; eye < kEyes.size(); ++eye)
    if (Exceeds(Kind::kEyesClosed, ClosingOf(eye), config_.max_closing)) return Errc::kRejected;

  ChooseAlike();
  for (std::size_t p = 0; p < points_; ++p)
    neutral.points_cm[p] = {MedianOf(&Point3::x, p), MedianOf(&Point3::y, p),
                            MedianOf(&Point3::z, p)};
  if (Exceeds(Kind::kFaceMoved, StrayOfATenth(neutral), config_.max_stray_cm) ||
      Exceeds(Kind::kMouthOpen, MouthGap(neutral), config_.max_mouth_gap))
    return Errc::kRejected;
  return neutral;
}

}  // namespace facewire::retarget
