#include "tools/facewire/performance.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/error.h"
#include "core/filter/landmark_filter.h"
#include "core/pose/pose_estimator.h"
#include "core/pose/similarity_fit.h"
#include "tools/markers/take.h"

namespace facewire::tools {
namespace {

class Video final : public Performance {
 public:
  explicit Video(const FaceOptions& options) : reader_(options) {}

  std::optional<Moment> Next() override {
    const auto frame = reader_.Next();
    if (!frame) return std::nullopt;
    if (!start_) start_ = frame->captured;
    Moment moment{frame->seq, (frame->captured - *start_).count(), std::nullopt};
    if (const auto face = Follow()) {
      moment.face = *face;
    } else {
      // As the service: who is lost is searched for anew.
      reader_.Lose();
      filter_.Reset();
    }
    return moment;
  }

 private:
  Result<FacePose> Follow() {
    const auto seen = reader_.Track();
    if (!seen) return seen.error();
    const auto steady = filter_.Update(*seen);
    if (!steady) return steady.error();
    return pose_.Update(*steady);
  }

  FaceReader reader_;
  filter::LandmarkFilter filter_{filter::FilterConfig{}};
  pose::PoseEstimator pose_{pose::PoseConfig{}};
  std::optional<Time> start_;
};

// The marker of the take for each name; throws with all names that it lacks.
std::vector<std::size_t> Find(const markers::Take& take, const std::vector<std::string>& names,
                              const std::string& path, const std::string& who) {
  std::vector<std::size_t> found;
  std::string missing;
  for (const std::string& name : names) {
    const auto at = std::ranges::find(take.names, name);
    if (at == take.names.end()) missing += (missing.empty() ? "" : ", ") + name;
    found.push_back(static_cast<std::size_t>(at - take.names.begin()));
  }
  if (!missing.empty())
    throw app::BadInput(path + ": " + who + " needs markers that it does not have: " + missing);
  return found;
}

bool Seen(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

class Markers final : public Performance {
 public:
  Markers(const std::string& path, const MarkerLayout& layout,
          const std::vector<std::string>& rigid)
      : path_(path),
        take_(markers::ReadTake(path)),
        read_(Find(take_, layout.names, path, layout.needed_by)),
        rigid_(Find(take_, rigid, path, "--rigid")),
        points_(layout.points) {}

  std::optional<Moment> Next() override {
    if (next_ == take_.frames.size()) return std::nullopt;
    const std::vector<Point3>& frame = take_.frames[next_];
    // A take that does not say its rate counts as one of 60 frames a second.
    const double rate = take_.rate_hz > 0 ? take_.rate_hz : 60;
    Moment moment{next_, std::llround(static_cast<double>(next_) * 1e6 / rate), std::nullopt};
    ++next_;
    if (!std::ranges::all_of(read_, [&](std::size_t m) { return Seen(frame[m]); })) return moment;
    FacePose face;
    face.seq = moment.frame;
    face.captured = Time{Duration{moment.t_us}};
    face.presence = 1;
    if (!rigid_.empty() && !FitHead(frame, face)) return moment;
    for (std::size_t i = 0; i < read_.size(); ++i) {
      const auto at = static_cast<std::size_t>(points_[i]);
      face.points_cm[at] = InHead(frame[read_[i]], face);
      face.count = std::max(face.count, at + 1);
    }
    moment.face = face;
    return moment;
  }

 private:
  // Where the rigid markers' first complete frame has gone. False while one of them is not seen.
  bool FitHead(const std::vector<Point3>& frame, FacePose& face) {
    if (!std::ranges::all_of(rigid_, [&](std::size_t m) { return Seen(frame[m]); })) return false;
    if (reference_.empty()) {
      for (const std::size_t m : rigid_) reference_.push_back(frame[m]);
    }
    std::vector<pose::PointPair> pairs;
    for (std::size_t i = 0; i < rigid_.size(); ++i)
      pairs.push_back({reference_[i], frame[rigid_[i]], 1});
    const auto fit = pose::FitSimilarity(pairs);
    if (!fit)
      throw app::BadInput(path_ + ": --rigid needs three markers or more that are not on one line");
    face.camera_R_head = fit->rotation;
    // Markers do not grow: the fit without its scale.
    face.camera_t_head_cm = fit->to_centre - fit->rotation * fit->from_centre;
    return true;
  }

  static Point3 InHead(Point3 p, const FacePose& face) {
    const Matrix3& r = face.camera_R_head;
    const Matrix3 back{r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
    return back * (p - face.camera_t_head_cm);
  }

  std::string path_;
  markers::Take take_;
  std::vector<std::size_t> read_;  // marker of the take for each of the layout's
  std::vector<std::size_t> rigid_;
  std::vector<std::int16_t> points_;  // of FacePose, for each of the layout's
  std::vector<Point3> reference_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<Performance> OpenVideo(const FaceOptions& options) {
  return std::make_unique<Video>(options);
}

std::unique_ptr<Performance> OpenMarkers(const std::string& path, const MarkerLayout& layout,
                                         const std::vector<std::string>& rigid) {
  return std::make_unique<Markers>(path, layout, rigid);
}

bool IsMarkerFile(const std::string& path) {
  const auto ends = [&](std::string_view ending) {
    return path.size() > ending.size() &&
           std::ranges::equal(path.substr(path.size() - ending.size()), ending, {},
                              [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  };
  return ends(".csv") || ends(".trc") || ends(".c3d");
}

}  // namespace facewire::tools
