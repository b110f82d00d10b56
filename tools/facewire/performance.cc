#include "tools/facewire/performance.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/filter/landmark_filter.h"
#include "core/pose/pose_estimator.h"
#include "tools/facewire/landmark_source.h"
#include "tools/facewire/marker_names.h"
#include "tools/markers/head_motion.h"
#include "tools/markers/take.h"

namespace facewire::tools {
namespace {

class Video final : public Performance {
 public:
  Video(const FaceOptions& options, Smoothing smoothing) : source_(OpenLandmarks(options)) {
    if (smoothing == Smoothing::kAsTheService) filter_.emplace(filter::FilterConfig{});
  }

  std::optional<PerformanceFrame> Next() override {
    const auto seen = source_->Next();
    if (!seen) return std::nullopt;
    PerformanceFrame moment{seen->frame, seen->t_us, std::nullopt};
    const auto face = seen->face ? Follow(*seen->face) : Result<FacePose>(Errc::kNoFace);
    if (face) {
      moment.face = *face;
    } else {
      // As the service: who is lost is searched for anew.
      source_->Lose();
      if (filter_) filter_->Reset();
    }
    return moment;
  }

 private:
  Result<FacePose> Follow(const Landmarks& seen) {
    const auto steady = filter_ ? filter_->Update(seen) : Result<Landmarks>(seen);
    if (!steady) return steady.error();
    return pose_.Update(*steady);
  }

  std::unique_ptr<LandmarkSource> source_;
  std::optional<filter::LandmarkFilter> filter_;
  pose::PoseEstimator pose_{pose::PoseConfig{}};
};

class Markers final : public Performance {
 public:
  Markers(const std::string& path, const MarkerLayout& layout,
          const std::vector<std::string>& rigid)
      : take_(markers::ReadTake(path)),
        read_(FindMarkers(take_.names, layout.names, path, layout.needed_by)),
        points_(layout.points),
        head_(rigid.empty() ? std::vector<std::size_t>{}
                            : FindMarkers(take_.names, rigid, path, "--rigid"),
              path) {}

  std::optional<PerformanceFrame> Next() override {
    if (next_ == take_.frames.size()) return std::nullopt;
    const std::vector<Point3>& frame = take_.frames[next_];
    PerformanceFrame moment{take_.Number(next_), take_.TimeUs(next_), std::nullopt};
    ++next_;
    const auto head = head_.Find(frame);
    if (!head ||
        !std::ranges::all_of(read_, [&](std::size_t m) { return markers::Seen(frame[m]); }))
      return moment;
    FacePose face;
    face.seq = moment.frame;
    face.captured = Time{Duration{moment.t_us}};
    face.presence = 1;
    face.camera_R_head = head->rotation;
    face.camera_t_head_cm = head->translation_cm;
    for (std::size_t i = 0; i < read_.size(); ++i) {
      const auto at = static_cast<std::size_t>(points_[i]);
      face.points_cm[at] = head->ToHead(frame[read_[i]]);
      face.count = std::max(face.count, at + 1);
    }
    moment.face = face;
    return moment;
  }

 private:
  markers::Take take_;
  std::vector<std::size_t> read_;     // marker of the take for each of the layout's
  std::vector<std::int16_t> points_;  // of FacePose, for each of the layout's
  markers::HeadMotion head_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<Performance> OpenVideo(const FaceOptions& options, Smoothing smoothing) {
  return std::make_unique<Video>(options, smoothing);
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
