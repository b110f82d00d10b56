#include "tests/support/generated_take.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/geometry.h"
#include "tests/support/generated_face.h"

namespace facewire::test {
namespace {

constexpr float kFps = 60;
enum Shape : std::size_t { kOpen, kForward, kBack, kLeft, kRight, kLipsLeft, kLipsRight, kFunnel };
constexpr std::array<const char*, 8> kShapes = {"jawOpen",    "jawForward", "jawBack",
                                                "jawLeft",    "jawRight",   "mouthLeft",
                                                "mouthRight", "mouthFunnel"};
using Weights = std::array<float, kShapes.size()>;

struct Marker {
  const char* name;
  const char* twin;  // on the right side; null in the middle
  Point3 rest_cm;    // of the left one; head frame
  float jaw = 0;     // how much of the jaw's motion it makes
  float lips = 0;    // how much of the lips' motion
};
constexpr std::array<Marker, 24> kMarkers = {{
    {"ForeHead_M", nullptr, {0, 7, 5.5F}},
    {"ForeHead_L", "ForeHead_R", {4.5F, 6, 4}},
    {"Leyebrow_M", "Reyebrow_M", {3.8F, 3.8F, 5}},
    {"Leyebrow_Inside", "Reyebrow_Inside", {1.9F, 3.5F, 6}},
    {"Leyebrow_Outside", "Reyebrow_Outside", {6, 2.6F, 3}},
    {"Eyebrow_Center", nullptr, {0, 3.2F, 6.6F}},
    {"NoseTop", nullptr, {0, 0, 7}},
    {"NoseHead", nullptr, {0, -2.6F, 9.2F}},
    {"NoseHead_L", "NoseHead_R", {2.1F, -3.4F, 6}},
    {"Leye_Up", "Reye_Up", {3.4F, 1.6F, 5.4F}},
    {"Leye_Down", "Reye_Down", {3.4F, -1.2F, 5.4F}},
    {"Leye_Inside", "Reye_Inside", {1.7F, -0.4F, 5.8F}},
    {"Leye_Outside", "Reye_Outside", {5.6F, -0.3F, 4}},
    {"Lcheek_Up", "Rcheek_up", {5.2F, -3.4F, 4.6F}},
    {"Lcheek_Down", "Rcheek_Down", {5, -6.2F, 3.8F}, 0.25F},
    {"Lcheek_Outside", "Rcheek_Outside", {6.6F, -4, 1.6F}, 0.1F},
    {"Mouth_Up", nullptr, {0, -5.2F, 7.6F}, 0, 1},
    {"Mouth_Down", nullptr, {0, -8.4F, 7}, 0.95F, 1},
    {"Mouth_UpL1", "Mouth_UpR1", {2, -5.4F, 7}, 0.05F, 1},
    {"Mouth_Lend", "Mouth_Rend", {3.6F, -6.8F, 5.6F}, 0.4F, 1},
    {"Mouth_DownL", "Mouth_DownR", {1.9F, -8, 6.6F}, 0.8F, 1},
    {"Chin", nullptr, {0, -11, 6.2F}, 1},
    {"Chin_L1", "Chin_R1", {3.2F, -10.4F, 4.8F}, 0.85F},
    {"Chin_L2", "Chin_R2", {5.2F, -8.2F, 2.4F}, 0.45F},
}};

struct Pose {
  Shape first;
  float first_weight;
  Shape second;
  float second_weight;
};
constexpr std::array<Pose, 9> kPoses = {{
    {kOpen, 1, kFunnel, 0.5F},
    {kForward, 1, kForward, 1},
    {kBack, 1, kBack, 1},
    {kLeft, 1, kLipsLeft, 0.6F},
    {kRight, 1, kLipsRight, 0.6F},
    {kLipsLeft, 0.8F, kLipsLeft, 0.8F},
    {kLipsRight, 0.8F, kLipsRight, 0.8F},
    {kOpen, 0.5F, kFunnel, 0.25F},
    {kLeft, 0.5F, kLeft, 0.5F},
}};
constexpr float kRest = 1, kReach = 0.4F, kHold = 0.4F, kPause = 0.2F;  // seconds
constexpr float kPose = kReach + kHold + kReach + kPause;

// Of a pose that began `t` seconds ago: raised cosines around the hold.
float Envelope(float t) {
  const auto rise = [](float part) {
    return 0.5F - 0.5F * std::cos(std::numbers::pi_v<float> * std::clamp(part, 0.0F, 1.0F));
  };
  return rise(t / kReach) - rise((t - kReach - kHold) / kReach);
}

Weights WeightsAt(float t) {
  Weights weights{};
  const float since = t - kRest;
  if (since < 0) return weights;
  const auto at = static_cast<std::size_t>(since / kPose);
  if (at >= kPoses.size()) return weights;
  const float envelope = Envelope(since - static_cast<float>(at) * kPose);
  weights[kPoses[at].first] = kPoses[at].first_weight * envelope;
  weights[kPoses[at].second] = kPoses[at].second_weight * envelope;
  return weights;
}

// Where a marker is in the head frame. The jaw turns about an axis through the ears and slides.
Point3 InHead(const Marker& marker, Point3 rest, const Weights& w) {
  constexpr Point3 kHinge{0, -1, -6};
  constexpr float kOpenDeg = 18;
  const Point3 turned = Rotation(kOpenDeg * w[kOpen] * marker.jaw, 0, 0) * (rest - kHinge) + kHinge;
  const Point3 slid = {1.2F * (w[kLeft] - w[kRight]), 0, 1.6F * w[kForward] - 1.1F * w[kBack]};
  const Point3 lips = {0.8F * (w[kLipsLeft] - w[kLipsRight]) - 0.2F * w[kFunnel] * rest.x, 0,
                       0.4F * w[kFunnel]};
  return turned + marker.jaw * slid + marker.lips * lips;
}

Point3 InRoom(Point3 head, float t) {
  const Matrix3 turn =
      Rotation(6 * std::sin(0.7F * t + 1), 12 * std::sin(0.9F * t), 4 * std::sin(1.3F * t));
  return turn * head + Point3{14 + 2 * std::sin(0.5F * t), 80, -4 + std::sin(0.8F * t)};
}

void AppendRow(std::string& csv, std::size_t frame) { csv += "\n" + std::to_string(frame); }

}  // namespace

GeneratedTake GenerateTake() {
  GeneratedTake take;
  take.shapes.assign(kShapes.begin(), kShapes.end());
  take.markers_csv = "frame,time_s";
  take.weights_csv = "frame";
  for (const char* shape : kShapes) take.weights_csv.append(",").append(shape);
  for (const Marker& marker : kMarkers) {
    for (const char* name : {marker.name, marker.twin}) {
      if (name == nullptr) continue;
      for (const char* axis : {"_x", "_y", "_z"})
        take.markers_csv.append(",").append(name).append(axis);
    }
  }
  const auto frames = static_cast<std::size_t>(kFps * (kRest + kPose * kPoses.size()));
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const float t = static_cast<float>(frame) / kFps;
    const Weights weights = WeightsAt(t);
    take.weights.emplace_back(weights.begin(), weights.end());
    AppendRow(take.weights_csv, frame);
    for (const float weight : weights) take.weights_csv += "," + std::to_string(weight);
    AppendRow(take.markers_csv, frame);
    take.markers_csv +=
        "," + std::to_string(static_cast<double>(frame) / static_cast<double>(kFps));
    for (const Marker& marker : kMarkers) {
      for (const float side : {1.0F, -1.0F}) {
        if (side < 0 && marker.twin == nullptr) continue;
        const Point3 rest{side * marker.rest_cm.x, marker.rest_cm.y, marker.rest_cm.z};
        const Point3 p = InRoom(InHead(marker, rest, weights), t);
        for (const float v : {p.x, p.y, p.z}) take.markers_csv += "," + std::to_string(v);
      }
    }
  }
  take.markers_csv += "\n";
  take.weights_csv += "\n";
  return take;
}

}  // namespace facewire::test
