#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <string>

#include "core/filter/landmark_filter.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/face_reader.h"
#include "tools/facewire/json.h"
#include "tools/facewire/output_file.h"
#include "tools/facewire/stop_flag.h"

namespace facewire::tools {
namespace {

struct TrackOptions {
  FaceOptions face;
  std::string out;
  bool filtered = false;
};

// A thousandth of a pixel: far below what the networks resolve.
constexpr int kDecimals = 3;

std::string Line(const Frame& frame, Time start, const Result<Landmarks>& face) {
  std::string line = "{\"frame\":";
  json::AppendInteger(line, static_cast<std::int64_t>(frame.seq));
  line += ",\"t_us\":";
  json::AppendInteger(line, (frame.captured - start).count());
  line += face ? ",\"state\":\"tracking\",\"presence\":" : ",\"state\":\"searching\",\"presence\":";
  json::AppendNumber(line, face ? static_cast<double>(face->presence) : 0.0, 4);
  line += ",\"landmarks\":";
  if (!face) return line + "null}\n";
  char separator = '[';
  for (std::size_t i = 0; i < face->count; ++i) {
    const Point3& p = face->points_px[i];
    line += separator;
    char inner = '[';
    for (const float v : {p.x, p.y, p.z}) {
      line += inner;
      json::AppendNumber(line, static_cast<double>(v), kDecimals);
      inner = ',';
    }
    line += ']';
    separator = ',';
  }
  return line + "]}\n";
}

void Track(const TrackOptions& options) {
  std::optional<StopFlag> stop;
  if (IsLive(options.face.input)) stop.emplace();
  FaceReader reader(options.face);
  OutputFile out(options.out);
  std::optional<filter::LandmarkFilter> filter;
  if (options.filtered) filter.emplace(filter::FilterConfig{});
  std::optional<Time> start;
  std::size_t frames = 0;
  std::size_t faces = 0;
  while (!(stop && stop->Raised())) {
    const auto frame = reader.Next();
    if (!frame) break;
    if (!start) start = frame->captured;
    auto face = reader.Track();
    if (filter && face) {
      face = filter->Update(*face);
    }
    if (filter && !face) filter->Reset();
    ++frames;
    faces += face ? 1 : 0;
    out.Write(Line(*frame, *start, face));
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
                   "A video file, v4l2:/dev/videoN or libcamera:N; Ctrl-C ends a camera's take")
      ->required();
  command->add_option("--out", options->out, "The JSON lines file to write")->required();
  AddFaceOptions(*command, options->face);
  command->add_flag("--filtered", options->filtered,
                    "Smooth the landmarks and drop failed tracking, as the service does");
  command->callback([options] { Track(*options); });
}

}  // namespace facewire::tools
