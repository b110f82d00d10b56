#ifndef FACEWIRE_CORE_TRACK_ATTENTION_OPS_H_
#define FACEWIRE_CORE_TRACK_ATTENTION_OPS_H_

#include <span>

#include "core/track/custom_options.h"

namespace facewire::track {

// The three operations of the attention network that are MediaPipe's own (version 2 of each; the
// rules are those of mediapipe/util/tflite/operations, Apache-2.0). A part of the face is cut out
// of a feature map, upright and enlarged; a small network refines the part's landmarks in the cut;
// the refined landmarks are put back.

// Where a cut lies: cut coordinates (x right, y down, (0,0) its top-left corner) to those outside.
//   outside_x = xx * x + xy * y + x0,   outside_y = yx * x + yy * y + y0
struct CutTransform {
  float xx = 1, xy = 0, x0 = 0;
  float yx = 0, yy = 1, y0 = 0;
};

// Landmarks2TransformMatrix: the cut around the options' subset of the mesh, turned so that its two
// rotation points lie level. `mesh` holds x, y, z of kMeshLandmarks points, each scaled by `scale`
// into the coordinates in which the cut is wanted.
CutTransform PartTransform(const PartOptions& options, std::span<const float> mesh,
                           float scale) noexcept;

struct FeatureMap {
  std::span<const float> values;  // height x width x channels, channels last
  int width = 0;
  int height = 0;
  int channels = 0;
};

// TransformTensorBilinear: samples the map at the centres of the cut's width x height cells. A cell
// whose centre is outside the map's outermost cell centres gets zeros. `cut` holds
// height x width x channels floats.
void CutFeatures(const FeatureMap& map, const CutTransform& transform, int cut_width,
                 int cut_height, std::span<float> cut) noexcept;

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_ATTENTION_OPS_H_
