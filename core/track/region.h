#ifndef FACEWIRE_CORE_TRACK_REGION_H_
#define FACEWIRE_CORE_TRACK_REGION_H_

#include <array>
#include <cstddef>
#include <span>

#include "core/base/geometry.h"

namespace facewire::track {

// A turned square of the picture in which a face is, in pixels (see core/landmarks.h).
struct Region {
  float center_x_px = 0;
  float center_y_px = 0;
  float side_px = 0;
  float angle_rad =
      0;  // from the picture's x axis to the region's, positive from x to y (clockwise)
};

// A face as the detector sees it, in pixels.
struct Detection {
  float score = 0;                   // 0..1
  float min_x_px = 0, min_y_px = 0;  // its box
  float max_x_px = 0, max_y_px = 0;
  std::array<Point3, 6>
      keypoints_px{};  // image-left eye, image-right eye, nose, mouth, ears; z = 0
};

// Whether pixels can be taken from it: finite, larger than 1 px, not absurdly far or large.
bool IsUsable(const Region& region) noexcept;

// How much larger the region is than the box around a face (MediaPipe's face_landmark graphs).
inline constexpr float kRegionMargin = 1.5F;

// Where the landmark network looks: around the box, level with the eyes.
Region RegionOf(const Detection& detection) noexcept;

// Where it looks in the next frame: around all landmarks of this one, level with the eyes' outer
// corners. At least kMeshLandmarks points.
Region RegionOf(std::span<const Point3> landmarks_px) noexcept;

// Takes a network's point in its crop of crop_size x crop_size pixels back to the picture.
class CropToPicture {
 public:
  CropToPicture(const Region& region, float crop_size) noexcept;
  Point3 operator()(Point3 in_crop) const noexcept;
  // The same for a difference of two points.
  Point3 Turn(Point3 in_crop) const noexcept;

 private:
  float scale_;                // pixels of the picture in one of the crop
  float cos_, sin_;            // both times scale_
  float origin_x_, origin_y_;  // where the crop's top-left corner lies in the picture
};

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_REGION_H_
