#ifndef FACEWIRE_TOOLS_MARKERS_HEAD_MOTION_H_
#define FACEWIRE_TOOLS_MARKERS_HEAD_MOTION_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/geometry.h"

namespace facewire::tools::markers {

// Where a head is in the axes of the markers: take_p = rotation * head_p + translation_cm.
struct HeadPlace {
  Matrix3 rotation = kIdentity3;
  Point3 translation_cm{};
  Point3 ToHead(Point3 take_p) const;
};

// Finds where the head is in each frame from markers that only follow the skull. The head frame has
// the axes of the first frame that shows them all. Without such markers there is no head motion.
class HeadMotion {
 public:
  // `rigid`: indices of markers; `name`: of the take, for messages.
  HeadMotion(std::vector<std::size_t> rigid, std::string name)
      : rigid_(std::move(rigid)), name_(std::move(name)) {}

  // nullopt while a rigid marker is not seen. Throws BadInput when they cannot give an attitude:
  // fewer than three, or all on one line.
  std::optional<HeadPlace> Find(const std::vector<Point3>& frame);

  // Root mean square distance of the rigid markers from where the fit puts them, over all frames so
  // far, cm: how rigid they are.
  double misfit_cm() const;

 private:
  std::vector<std::size_t> rigid_;
  std::string name_;
  std::vector<Point3> reference_;
  double squares_cm2_ = 0;
  std::size_t fitted_ = 0;  // markers, over all frames
};

// All three coordinates are there.
bool Seen(Point3 p);

}  // namespace facewire::tools::markers

#endif  // FACEWIRE_TOOLS_MARKERS_HEAD_MOTION_H_
