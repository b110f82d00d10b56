#include "core/filter/landmark_filter.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/filter/regions.h"

namespace facewire::filter {
namespace {

bool IsPositive(float v) noexcept { return std::isfinite(v) && v > 0; }
bool IsNotNegative(float v) noexcept { return std::isfinite(v) && v >= 0; }

bool IsValid(const OneEuroConfig& c) noexcept {
  return IsPositive(c.min_cutoff_hz) && IsNotNegative(c.beta) &&
         IsPositive(c.derivative_cutoff_hz) && IsNotNegative(c.speed_floor);
}

// How much of a new sample a first-order low-pass takes.
float Share(float cutoff_hz, float step_s) noexcept {
  const float x = 2 * std::numbers::pi_v<float> * cutoff_hz * step_s;
  return x / (x + 1);
}

std::array<float, 3> Coordinates(Point3 p) noexcept { return {p.x, p.y, p.z}; }

}  // namespace

Result<> Validate(const FilterConfig& config) noexcept {
  const PlausibilityConfig& p = config.plausibility;
  const bool valid = IsValid(config.eyes) && IsValid(config.mouth) && IsValid(config.rest) &&
                     p.min_presence >= 0 && p.min_presence <= 1 && IsPositive(p.min_size_px) &&
                     IsPositive(p.max_speed_sizes_per_s) && IsPositive(p.max_size_ratio - 1) &&
                     config.believe_after >= 1 && config.max_gap > Duration::zero();
  if (!valid) return Errc::kOutOfRange;
  return {};
}

LandmarkFilter::LandmarkFilter(const FilterConfig& config) noexcept : config_(config) {}

void LandmarkFilter::Reset() noexcept {
  last_.reset();
  elsewhere_.reset();
  agreeing_ = 0;
}

bool LandmarkFilter::Continues(const Landmarks& in) const noexcept {
  if (!last_ || in.count != count_ || in.width_px != width_px_ || in.height_px != height_px_) {
    return false;
  }
  const Duration step = Between(last_->at, in.captured);
  return step >= Duration::zero() && step <= config_.max_gap;
}

// Whether a face that jumped has been where it is now for long enough.
bool LandmarkFilter::Believes(const Extent& face) noexcept {
  const bool agrees =
      elsewhere_ && face.at > elsewhere_->at && !Jumped(*elsewhere_, face, config_.plausibility);
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  elsewhere_ = face;
  return agreeing_ >= config_.believe_after;
}

void LandmarkFilter::Start(const Landmarks& in) noexcept {
  for (std::size_t i = 0; i < in.count; ++i) points_[i] = {Coordinates(in.points_px[i]), {}};
  count_ = in.count;
  width_px_ = in.width_px;
  height_px_ = in.height_px;
}

void LandmarkFilter::Smooth(const Landmarks& in, float step_s, float size_px) noexcept {
  // By Region.
  const std::array<const OneEuroConfig*, 3> settings = {&config_.rest, &config_.eyes,
                                                        &config_.mouth};
  const float per_size_and_second = 1 / (step_s * size_px);
  for (std::size_t i = 0; i < count_; ++i) {
    const OneEuroConfig& c = *settings[static_cast<std::size_t>(kRegionOf[i])];
    const float speed_share = Share(c.derivative_cutoff_hz, step_s);
    const std::array<float, 3> now = Coordinates(in.points_px[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float& value = points_[i].value_px[axis];
      float& speed = points_[i].speed[axis];
      const float away = now[axis] - value;
      speed += speed_share * (away * per_size_and_second - speed);
      const float excess = std::fmax(0.F, std::abs(speed) - c.speed_floor);
      value += Share(c.min_cutoff_hz + c.beta * excess, step_s) * away;
    }
  }
}

Landmarks LandmarkFilter::Answer(const Landmarks& in) const noexcept {
  Landmarks out = in;
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& v = points_[i].value_px;
    out.points_px[i] = {v[0], v[1], v[2]};
  }
  return out;
}

Result<Landmarks> LandmarkFilter::Update(const Landmarks& in) noexcept {
  const std::optional<Extent> face = MeasureFace(in, config_.plausibility);
  if (!face) {
    elsewhere_.reset();
    return Errc::kRejected;
  }
  bool continues = Continues(in);
  if (continues && face->at == last_->at) return Answer(in);
  if (continues && Jumped(*last_, *face, config_.plausibility)) {
    if (!Believes(*face)) return Errc::kRejected;
    continues = false;
  }
  if (continues) {
    Smooth(in, Seconds(face->at - last_->at), face->size_px);
  } else {
    Start(in);
  }
  last_ = face;
  elsewhere_.reset();
  return Answer(in);
}

}  // namespace facewire::filter
