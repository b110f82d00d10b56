#include "tools/facewire/landmark_source.h"

namespace facewire::tools {
namespace {

class Tracked final : public LandmarkSource {
 public:
  explicit Tracked(const FaceOptions& options) : reader_(options) {}

  std::optional<Sighting> Next() override {
    const auto frame = reader_.Next();
    if (!frame) return std::nullopt;
    if (!start_) start_ = frame->captured;
    Sighting seen{frame->seq, (frame->captured - *start_).count(), std::nullopt};
    if (const auto face = reader_.Track()) seen.face = *face;
    return seen;
  }
  void Lose() override { reader_.Lose(); }

 private:
  FaceReader reader_;
  std::optional<Time> start_;
};

class Read final : public LandmarkSource {
 public:
  explicit Read(const std::string& path) : file_(path) {}
  std::optional<Sighting> Next() override { return file_.Next(); }
  void Lose() override {}

 private:
  LandmarkFile file_;
};

}  // namespace

std::unique_ptr<LandmarkSource> OpenLandmarks(const FaceOptions& options) {
  if (IsLandmarkFile(options.input)) return std::make_unique<Read>(options.input);
  return std::make_unique<Tracked>(options);
}

}  // namespace facewire::tools
