#include "core/track/face_detector.h"

#include <algorithm>
#include <cmath>

#include "core/track/crop.h"

namespace facewire::track {
namespace {

// Tensors of face_detection_short_range.tflite. Scores and boxes of the two grids are taken before
// the network concatenates them, which XNNPACK cannot.
constexpr std::array<int, 1> kInput = {0};
constexpr std::array<int, 4> kOutputs = {160, 163, 166, 169};

constexpr float kInputPixels = kDetectorSize;
constexpr float kMaxOverlap = 0.3F;

Detection Decode(std::span<const float, kBoxNumbers> box, Anchor anchor, float score) noexcept {
  const auto at = [&](std::size_t i) {
    return Point3{box[i] / kInputPixels + anchor.x, box[i + 1] / kInputPixels + anchor.y, 0};
  };
  const Point3 center = at(0);
  const float half_w = 0.5F * box[2] / kInputPixels;
  const float half_h = 0.5F * box[3] / kInputPixels;
  Detection d = {.score = score,
                 .min_x_px = center.x - half_w,
                 .min_y_px = center.y - half_h,
                 .max_x_px = center.x + half_w,
                 .max_y_px = center.y + half_h};
  for (std::size_t k = 0; k < d.keypoints_px.size(); ++k) d.keypoints_px[k] = at(4 + 2 * k);
  return d;
}

// Intersection over union of the boxes.
float Overlap(const Detection& a, const Detection& b) noexcept {
  const float w = std::min(a.max_x_px, b.max_x_px) - std::max(a.min_x_px, b.min_x_px);
  const float h = std::min(a.max_y_px, b.max_y_px) - std::max(a.min_y_px, b.min_y_px);
  if (!(w > 0 && h > 0)) return 0;
  const auto area = [](const Detection& d) {
    return (d.max_x_px - d.min_x_px) * (d.max_y_px - d.min_y_px);
  };
  return w * h / (area(a) + area(b) - w * h);
}

void Add(const Detection& d, float weight, Detection& sum) noexcept {
  sum.min_x_px += weight * d.min_x_px;
  sum.min_y_px += weight * d.min_y_px;
  sum.max_x_px += weight * d.max_x_px;
  sum.max_y_px += weight * d.max_y_px;
  for (std::size_t k = 0; k < d.keypoints_px.size(); ++k) {
    sum.keypoints_px[k] = sum.keypoints_px[k] + weight * d.keypoints_px[k];
  }
}

float Sigmoid(float logit) noexcept {
  return 1.0F / (1.0F + std::exp(-std::clamp(logit, -100.0F, 100.0F)));
}

// From fractions of the detector's square input to pixels of the picture that lies centred in it.
Detection ToPicture(const Detection& d, const ImageView& image) noexcept {
  const auto width = static_cast<float>(image.width_px);
  const auto height = static_cast<float>(image.height_px);
  const float side = std::max(width, height);
  const float left = 0.5F * (width - side);
  const float top = 0.5F * (height - side);
  Detection out = {.score = d.score,
                   .min_x_px = d.min_x_px * side + left,
                   .min_y_px = d.min_y_px * side + top,
                   .max_x_px = d.max_x_px * side + left,
                   .max_y_px = d.max_y_px * side + top};
  for (std::size_t k = 0; k < d.keypoints_px.size(); ++k) {
    out.keypoints_px[k] = side * d.keypoints_px[k] + Point3{left, top, 0};
  }
  return out;
}

}  // namespace

Anchors MakeAnchors() noexcept {
  struct Grid {
    int cells, per_cell;
  };
  Anchors anchors;
  std::size_t next = 0;
  for (const Grid grid : {Grid{16, 2}, Grid{8, 6}}) {
    for (int y = 0; y < grid.cells; ++y) {
      for (int x = 0; x < grid.cells; ++x) {
        const Anchor anchor = {(static_cast<float>(x) + 0.5F) / static_cast<float>(grid.cells),
                               (static_cast<float>(y) + 0.5F) / static_cast<float>(grid.cells)};
        for (int i = 0; i < grid.per_cell; ++i) anchors[next++] = anchor;
      }
    }
  }
  return anchors;
}

Result<Detection> DecodeBest(const RawDetections& raw, const Anchors& anchors,
                             float min_score) noexcept {
  const auto decode = [&](std::size_t i) {
    return Decode(raw.boxes.subspan(i * kBoxNumbers).first<kBoxNumbers>(), anchors[i],
                  Sigmoid(raw.scores[i]));
  };
  std::size_t best = kAnchors;
  for (std::size_t i = 0; i < kAnchors; ++i) {
    if (std::isnan(raw.scores[i])) continue;
    if (best == kAnchors || raw.scores[i] > raw.scores[best]) best = i;
  }
  if (best == kAnchors || !(Sigmoid(raw.scores[best]) >= min_score)) return Errc::kNoFace;

  const Detection top = decode(best);
  Detection sum;
  float weights = 0;
  for (std::size_t i = 0; i < kAnchors; ++i) {
    if (!(Sigmoid(raw.scores[i]) >= min_score)) continue;
    const Detection candidate = decode(i);
    if (i != best && !(Overlap(candidate, top) > kMaxOverlap)) continue;
    Add(candidate, candidate.score, sum);
    weights += candidate.score;
  }
  Detection mean = {.score = top.score};
  Add(sum, 1.0F / weights, mean);
  return mean;
}

Result<> FaceDetector::Build(const TfliteModel& model, NetworkMemory& memory) noexcept {
  if (auto built = network_.Build(model, kInput, kOutputs, memory); !built) return built;
  // Candidates of the finer grid first, as in the anchors.
  constexpr std::array<std::size_t, 4> kSizes = {512, 384, 512 * kBoxNumbers, 384 * kBoxNumbers};
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    if (network_.output(i).size() != kSizes[i]) return Errc::kCorrupt;
  }
  if (network_.input(0).size() != std::size_t{3} * kDetectorSize * kDetectorSize)
    return Errc::kCorrupt;
  anchors_ = MakeAnchors();
  return {};
}

Result<Detection> FaceDetector::Detect(const ImageView& image, float min_score) noexcept {
  if (network_.input(0).empty()) return Errc::kNotReady;
  CropLetterbox(image, network_.input(0));
  if (auto run = network_.Run(); !run) return run.error();
  auto score = std::ranges::copy(network_.output(0), scores_.begin()).out;
  std::ranges::copy(network_.output(1), score);
  auto box = std::ranges::copy(network_.output(2), boxes_.begin()).out;
  std::ranges::copy(network_.output(3), box);
  auto best = DecodeBest({scores_, boxes_}, anchors_, min_score);
  if (!best) return best;
  return ToPicture(*best, image);
}

}  // namespace facewire::track
