#include "tools/markers/head_motion.h"

#include <algorithm>
#include <cmath>

#include "app/error.h"
#include "core/pose/similarity_fit.h"

namespace facewire::tools::markers {

Point3 HeadPlace::ToHead(Point3 take_p) const {
  const Matrix3& r = rotation;
  const Matrix3 back{r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
  return back * (take_p - translation_cm);
}

bool Seen(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

std::optional<HeadPlace> HeadMotion::Find(const std::vector<Point3>& frame) {
  if (rigid_.empty()) return HeadPlace{};
  if (!std::ranges::all_of(rigid_, [&](std::size_t m) { return Seen(frame[m]); }))
    return std::nullopt;
  if (reference_.empty()) {
    for (const std::size_t m : rigid_) reference_.push_back(frame[m]);
  }
  std::vector<pose::PointPair> pairs;
  for (std::size_t i = 0; i < rigid_.size(); ++i)
    pairs.push_back({reference_[i], frame[rigid_[i]], 1});
  const auto fit = pose::FitSimilarity(pairs);
  if (!fit)
    throw app::BadInput(name_ + ": --rigid needs three markers or more that are not on one line");
  // Markers do not grow: the fit without its scale.
  const HeadPlace head{fit->rotation, fit->to_centre - fit->rotation * fit->from_centre};
  for (std::size_t i = 0; i < rigid_.size(); ++i) {
    const Point3 off = head.ToHead(frame[rigid_[i]]) - reference_[i];
    squares_cm2_ += static_cast<double>(Dot(off, off));
  }
  fitted_ += rigid_.size();
  return head;
}

double HeadMotion::misfit_cm() const {
  return fitted_ == 0 ? 0 : std::sqrt(squares_cm2_ / static_cast<double>(fitted_));
}

}  // namespace facewire::tools::markers
