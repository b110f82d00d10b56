#include "tests/support/generated_markers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facewire::test {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr Point3 kMouth{0, -3.6F, 10.3F};

// The front of the face, without nose.
float Depth(float x, float y) { return 10.5F - 0.11F * x * x - 0.02F * y * y; }

// `count` points of an ellipse, clockwise as the viewer sees it from the person's right corner on.
void Ellipse(MarkerPoints& out, std::size_t first, std::size_t count, Point3 centre, float wide,
             float up, float down) {
  for (std::size_t i = 0; i < count; ++i) {
    const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(count);
    const float high = std::sin(angle);
    const float x = centre.x - wide * std::cos(angle);
    const float y = centre.y + (high > 0 ? up : down) * high;
    out[first + i] = {x, y, Depth(x, y) + centre.z};
  }
}

// Comes and goes: 0 at the start and half of the time, at most 1.
float Wave(float t_s, float hz) { return std::max(0.0F, std::sin(2 * kPi * hz * t_s)); }

// How much of the jaw's rotation a marker takes part in.
float OnTheJaw(std::size_t i) {
  if (i <= 16) {  // the more, the nearer to the chin
    const float off = std::abs(static_cast<float>(i) - 8) / 8;
    return std::clamp(1.4F * (1 - off), 0.0F, 1.0F);
  }
  if (i >= 55 && i <= 59) return 0.9F;  // the lower lip
  if (i >= 65) return 0.9F;
  return i == 48 || i == 54 || i == 60 || i == 64 ? 0.4F : 0.0F;  // the corners
}

Point3 Opened(Point3 p, float angle) {
  constexpr Point3 kJoint{0, 1.5F, 0};
  const Point3 d = p - kJoint;
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return kJoint + Point3{d.x, c * d.y - s * d.z, s * d.y + c * d.z};
}

}  // namespace

MarkerPoints NeutralMarkers() {
  MarkerPoints out{};
  for (std::size_t i = 0; i < 17; ++i) {
    const float angle = kPi * (static_cast<float>(i) - 8) / 16;
    const float c = std::cos(angle);
    out[i] = {7.2F * std::sin(angle), 3.5F - 10.9F * c, 4 + 6 * c * c};
  }
  for (std::size_t i = 0; i < 5; ++i) {
    const float along = static_cast<float>(i) / 4;
    const float x = 5.4F - 4.3F * along;
    const float y = 5.1F + 0.9F * std::sin(kPi * (0.15F + 0.65F * along));
    out[17 + i] = {-x, y, Depth(x, y) + 0.5F};
    out[26 - i] = {x, y, Depth(x, y) + 0.5F};
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const float down = static_cast<float>(i) / 3;
    out[27 + i] = {0, 3.9F - 4.4F * down, 10.6F + 2 * down};
  }
  for (std::size_t i = 0; i < 5; ++i) {
    const float x = 0.7F * (static_cast<float>(i) - 2);
    out[31 + i] = {x, -1.4F, 11.6F - 0.35F * x * x};
  }
  Ellipse(out, 36, 6, {-3.2F, 3.2F, -0.8F}, 1.4F, 0.5F, 0.45F);
  Ellipse(out, 42, 6, {3.2F, 3.2F, -0.8F}, 1.4F, 0.5F, 0.45F);
  Ellipse(out, 48, 12, {0, kMouth.y, 0.3F}, 2.5F, 0.8F, 1.1F);
  Ellipse(out, 60, 8, {0, kMouth.y, 0.2F}, 2, 0.04F, 0.04F);
  return out;
}

MarkerPoints PerformingMarkers(float t_s) {
  const float open = Wave(t_s, 0.71F);
  const float smile = Wave(t_s, 0.43F);
  const float pucker = Wave(t_s, 0.29F) * (1 - smile);
  const float brows = Wave(t_s, 0.37F);
  const float blink = Wave(t_s, 1.13F);
  MarkerPoints out = NeutralMarkers();
  for (std::size_t i = 48; i < kMarkerCount; ++i) {
    Point3& p = out[i];
    const float side = p.x / 2.5F;
    p = p + smile * side * side * Point3{0.9F * side, 0.7F, -0.6F};
    p = p + pucker * Point3{-0.4F * p.x, -0.2F * (p.y - kMouth.y), 0.7F};
  }
  for (std::size_t i = 17; i < 27; ++i) out[i] = out[i] + brows * Point3{0, 1, 0.2F};
  // Upper lids travel to the lower ones: (37, 41), (38, 40) and the same at the other eye.
  for (const std::size_t eye : {std::size_t{36}, std::size_t{42}}) {
    out[eye + 1] = out[eye + 1] + blink * (out[eye + 5] - out[eye + 1]);
    out[eye + 2] = out[eye + 2] + blink * (out[eye + 4] - out[eye + 2]);
  }
  // Positive about x: front down.
  for (std::size_t i = 0; i < kMarkerCount; ++i)
    out[i] = Opened(out[i], 0.28F * open * OnTheJaw(i));
  return out;
}

}  // namespace facewire::test
