#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <string>

#include "core/filter/landmark_filter.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/landmark_source.h"
#include "tools/facewire/output_file.h"
#include "tools/facewire/stop_flag.h"

namespace facewire::tools {
namespace {

struct TrackOptions {
  FaceOptions face;
  std::string out;
  bool filtered = false;
};

void Track(const TrackOptions& options) {
  std::optional<StopFlag> stop;
  if (IsLive(options.face.input)) stop.emplace();
  const auto source = OpenLandmarks(options.face);
  OutputFile out(options.out);
  std::optional<filter::LandmarkFilter> filter;
  if (options.filtered) filter.emplace(filter::FilterConfig{});
  std::size_t frames = 0;
  std::size_t faces = 0;
  while (!(stop && stop->Raised())) {
    auto seen = source->Next();
    if (!seen) break;
    if (filter && seen->face) {
      const auto steady = filter->Update(*seen->face);
      seen->face = steady ? std::optional<Landmarks>(*steady) : std::nullopt;
    }
    if (filter && !seen->face) filter->Reset();
    ++frames;
    faces += seen->face ? 1 : 0;
    out.Write(LandmarkLine(*seen));
  }
  out.Commit();
  std::fprintf(stderr, "facewire track: %zu frames, a face in %zu\n", frames, faces);
}

}  // namespace

void AddTrack(CLI::App& facewire) {
  auto options = std::make_shared<TrackOptions>();
  CLI::App* command = facewire.add_subcommand(
      "track", "Follow a face and write its landmarks, one JSON line a frame");
  command
      ->add_option("INPUT", options->face.input,
                   "A video file, v4l2:/dev/videoN, libcamera:N or libcamera:ID; Ctrl-C ends a "
                   "camera's take")
      ->required();
  command->add_option("--out", options->out, "The JSON lines file to write")->required();
  AddFaceOptions(*command, options->face);
  command->add_flag("--filtered", options->filtered,
                    "Smooth the landmarks and drop failed tracking, as the service does");
  command->callback([options] { Track(*options); });
}

}  // namespace facewire::tools
