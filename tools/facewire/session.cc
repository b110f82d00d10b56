#include "tools/facewire/session.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/error.h"
#include "tools/facewire/marker_names.h"
#include "tools/facewire/performance.h"
#include "tools/markers/head_motion.h"
#include "tools/markers/take.h"

namespace facewire::tools {
namespace {

std::vector<std::string> Chosen(const std::vector<std::string>& names,
                                const std::vector<std::size_t>& indices) {
  std::vector<std::string> chosen;
  chosen.reserve(indices.size());
  for (const std::size_t i : indices) chosen.push_back(names[i]);
  return chosen;
}

class FaceSession final : public Session {
 public:
  explicit FaceSession(const SessionOptions& options)
      : path_(options.face.input),
        wanted_(options.markers),
        performance_(OpenVideo(options.face,
                               options.unfiltered ? Smoothing::kNone : Smoothing::kAsTheService)) {
    if (!options.rigid.empty())
      throw app::BadInput("--rigid is for markers; a face's head motion is known");
  }

  std::optional<SessionFrame> Next() override {
    const auto moment = performance_->Next();
    if (!moment) return std::nullopt;
    SessionFrame frame{moment->frame, moment->t_us, {}};
    if (!moment->face) return frame;
    if (names_.empty()) Choose(moment->face->count);
    if (moment->face->count != count_)
      throw app::BadInput(path_ + ": frame " + std::to_string(frame.frame) + " has " +
                          std::to_string(moment->face->count) + " landmarks, those before have " +
                          std::to_string(count_));
    for (const std::size_t i : indices_) frame.points_cm.push_back(moment->face->points_cm[i]);
    return frame;
  }

  const std::vector<std::string>& names() const override { return names_; }

 private:
  void Choose(std::size_t count) {
    count_ = count;
    std::vector<std::string> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back("lm" + std::to_string(i));
    indices_ = FindMarkers(all, wanted_, path_, "--markers");
    names_ = Chosen(all, indices_);
  }

  std::string path_;
  std::vector<std::string> wanted_;
  std::unique_ptr<Performance> performance_;
  std::size_t count_ = 0;
  std::vector<std::size_t> indices_;
  std::vector<std::string> names_;
};

class MarkerSession final : public Session {
 public:
  explicit MarkerSession(const SessionOptions& options)
      : take_(markers::ReadTake(options.face.input)),
        indices_(FindMarkers(take_.names, options.markers, options.face.input, "--markers")),
        names_(Chosen(take_.names, indices_)),
        is_moved_(!options.rigid.empty()),
        head_(is_moved_ ? FindMarkers(take_.names, options.rigid, options.face.input, "--rigid")
                        : std::vector<std::size_t>{},
              options.face.input) {
    if (options.unfiltered)
      throw app::BadInput("--unfiltered is for faces; markers are never filtered");
  }

  std::optional<SessionFrame> Next() override {
    if (next_ == take_.frames.size()) return std::nullopt;
    const std::vector<Point3>& points = take_.frames[next_];
    SessionFrame frame{take_.Number(next_), take_.TimeUs(next_), {}};
    ++next_;
    const auto head = head_.Find(points);
    const auto seen = [&](std::size_t m) { return markers::Seen(points[m]); };
    if (!head || std::ranges::none_of(indices_, seen)) return frame;
    for (const std::size_t m : indices_)
      frame.points_cm.push_back(seen(m) ? head->ToHead(points[m]) : Point3{NAN, NAN, NAN});
    return frame;
  }

  const std::vector<std::string>& names() const override { return names_; }

  std::string Remark() const override {
    if (!is_moved_) return {};
    char text[96];
    std::snprintf(text, sizeof text, "the rigid markers keep their places to %.3f cm rms",
                  head_.misfit_cm());
    return text;
  }

 private:
  markers::Take take_;
  std::vector<std::size_t> indices_;
  std::vector<std::string> names_;
  bool is_moved_;
  markers::HeadMotion head_;
  std::size_t next_ = 0;
};

}  // namespace

void AddSessionOptions(CLI::App& command, const std::string& input, SessionOptions& options) {
  command
      .add_option(
          input, options.face.input,
          "Markers (.csv with NAME_x,NAME_y,NAME_z in cm, .trc, .c3d), what `facewire track` "
          "wrote (.jsonl), a video, v4l2:/dev/videoN or libcamera:N")
      ->required();
  command
      .add_option("--rigid", options.rigid,
                  "Markers that only follow the head, to take its motion out; without, there is "
                  "none in")
      ->delimiter(',');
  command
      .add_option("--markers", options.markers,
                  "Only these, in this order: NAME,.. or lm13,lm14,..")
      ->delimiter(',');
  command.add_flag("--unfiltered", options.unfiltered,
                   "Do not smooth a face's landmarks over time: for stills, which are no film");
  AddFaceOptions(command, options.face);
}

std::unique_ptr<Session> OpenSession(const SessionOptions& options) {
  if (IsMarkerFile(options.face.input)) return std::make_unique<MarkerSession>(options);
  return std::make_unique<FaceSession>(options);
}

}  // namespace facewire::tools
