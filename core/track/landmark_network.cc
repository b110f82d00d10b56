#include "core/track/landmark_network.h"

#include <algorithm>
#include <cmath>

#include "core/track/crop.h"

namespace facewire::track {
namespace {

constexpr std::size_t kInputFloats = std::size_t{3} * kLandmarkSize * kLandmarkSize;
constexpr std::size_t kMeshFloats = 3 * kMeshLandmarks;
constexpr std::size_t kIrisPoints = 5;
// The lids' contour leads each eye's subset; an iris lies at its mean depth.
constexpr std::size_t kContourPoints = 16;

// Tensors of face_landmark.tflite.
namespace mesh {
constexpr std::array<int, 1> kInput = {0};
constexpr std::array<int, 2> kOutputs = {213, 210};  // mesh, presence
}  // namespace mesh

// Tensors of face_landmark_with_attention.tflite: the cuts made between the two halves by
// operations that are not XNNPACK's are `kCuts`, from the feature map, by the matrices `kMatrices`.
namespace attention {
constexpr std::array<int, 1> kInput = {0};
constexpr std::array<int, 3> kOutputs = {35, 186, 710};  // feature map, mesh, presence
constexpr std::array<int, 3> kMatrices = {196, 197, 198};
constexpr std::array<int, 3> kCuts = {199, 200, 201};
constexpr std::array<int, 5> kRefined = {684, 687, 690, 693, 696};  // lips, eye, iris, eye, iris
}  // namespace attention

// Of each part: where its refined points and its iris are among kRefined; the lips have no iris.
struct PartOutputs {
  std::size_t points;
  std::size_t iris;
};
constexpr std::size_t kNone = attention::kRefined.size();
constexpr std::array<PartOutputs, 3> kPartOutputs = {{{0, kNone}, {1, 2}, {3, 4}}};

float Sigmoid(float logit) noexcept { return 1.0F / (1.0F + std::exp(-logit)); }

void ReadMesh(std::span<const float> floats, CropLandmarks& out) noexcept {
  for (std::size_t i = 0; i < kMeshLandmarks; ++i) {
    out.points[i] = {floats[3 * i], floats[3 * i + 1], floats[3 * i + 2]};
  }
  out.count = kMeshLandmarks;
}

// TransformLandmarks, with the scale from cells of the feature map to pixels of the crop.
Point3 Outside(const CutTransform& t, const float* xy, float scale) noexcept {
  // The network multiplies the translation of the matrix only: its refined points count cells of
  // the cut as pixels of the crop would.
  return {t.xx * xy[0] + t.xy * xy[1] + scale * t.x0, t.yx * xy[0] + t.yy * xy[1] + scale * t.y0,
          0};
}

}  // namespace

Result<> MeshNetwork::Build(const TfliteModel& model, NetworkMemory& memory) noexcept {
  if (auto built = network_.Build(model, mesh::kInput, mesh::kOutputs, memory); !built)
    return built;
  if (network_.input(0).size() != kInputFloats || network_.output(0).size() != kMeshFloats ||
      network_.output(1).size() != 1) {
    return Errc::kCorrupt;
  }
  return {};
}

Result<> MeshNetwork::Run(CropLandmarks& out) noexcept {
  if (auto run = network_.Run(); !run) return run;
  ReadMesh(network_.output(0), out);
  out.presence = Sigmoid(network_.output(1)[0]);
  return {};
}

Result<> AttentionNetwork::Build(const TfliteModel& model, NetworkMemory& memory) noexcept {
  for (std::size_t part = 0; part < kParts; ++part) {
    const int producer = model.ProducerOf(attention::kMatrices[part]);
    if (producer < 0) return Errc::kCorrupt;
    const Operator op = model.op(producer);
    if (op.custom_name != "Landmarks2TransformMatrix") return Errc::kCorrupt;
    auto options = ReadPartOptions(op.custom_options);
    if (!options) return options.error();
    options_[part] = *options;
  }
  if (auto built = mesh_.Build(model, attention::kInput, attention::kOutputs, memory); !built)
    return built;
  if (auto built = parts_.Build(model, attention::kCuts, attention::kRefined, memory); !built)
    return built;

  const Shape map = model.tensor(attention::kOutputs[0]).shape;
  features_ = {.values = mesh_.output(0), .width = map[2], .height = map[1], .channels = map[3]};
  if (mesh_.input(0).size() != kInputFloats || mesh_.output(1).size() != kMeshFloats ||
      mesh_.output(2).size() != 1 || map[1] < 2 || map[2] < 2) {
    return Errc::kCorrupt;
  }
  for (std::size_t part = 0; part < kParts; ++part) {
    const PartOptions& o = options_[part];
    const Shape cut = model.tensor(attention::kCuts[part]).shape;
    if (cut != Shape{1, o.output_height, o.output_width, features_.channels}) return Errc::kCorrupt;
    const auto [points, iris] = kPartOutputs[part];
    if (parts_.output(points).size() != 2 * o.subset.size()) return Errc::kCorrupt;
    if (iris == kNone) continue;
    if (parts_.output(iris).size() != 2 * kIrisPoints || o.subset.size() < kContourPoints) {
      return Errc::kCorrupt;
    }
  }
  return {};
}

Result<> AttentionNetwork::Run(CropLandmarks& out) noexcept {
  if (auto run = mesh_.Run(); !run) return run;
  const std::span<const float> mesh = mesh_.output(1);
  // The feature map is smaller than the crop: 48 against 192.
  const float to_features = static_cast<float>(features_.width) / static_cast<float>(kLandmarkSize);
  std::array<CutTransform, kParts> transforms;
  for (std::size_t part = 0; part < kParts; ++part) {
    const PartOptions& options = options_[part];
    transforms[part] = PartTransform(options, mesh, to_features);
    CutFeatures(features_, transforms[part], options.output_width, options.output_height,
                parts_.input(part));
  }
  if (auto run = parts_.Run(); !run) return run;

  ReadMesh(mesh, out);
  out.presence = Sigmoid(mesh_.output(2)[0]);
  for (std::size_t part = 0; part < kParts; ++part) {
    const auto [points, iris] = kPartOutputs[part];
    const auto& subset = options_[part].subset;
    const auto place = [&](const float* xy) {
      return Outside(transforms[part], xy, 1.0F / to_features);
    };
    const float* refined = parts_.output(points).data();
    for (std::size_t i = 0; i < subset.size(); ++i) {
      Point3& point = out.points[subset[i]];
      const Point3 at = place(refined + 2 * i);
      point = {at.x, at.y, point.z};
    }
    if (iris == kNone) continue;
    float depth = 0;
    for (std::size_t i = 0; i < kContourPoints; ++i) depth += out.points[subset[i]].z;
    depth /= static_cast<float>(kContourPoints);
    for (std::size_t i = 0; i < kIrisPoints; ++i) {
      const Point3 at = place(parts_.output(iris).data() + 2 * i);
      out.points[out.count++] = {at.x, at.y, depth};
    }
  }
  return {};
}

}  // namespace facewire::track
