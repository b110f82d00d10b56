#include "tools/sheet/sheet.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/error.h"
#include "app/rig_file.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/face_reader.h"
#include "tools/facewire/output_file.h"
#include "tools/facewire/recording.h"
#include "tools/facewire/servo_sheet.h"
#include "tools/facewire/training_sheet.h"
#include "tools/sheet/pick.h"
#include "tools/sheet/png.h"

namespace facewire::tools {
namespace {

struct SheetOptions {
  std::string training;  // a sheet of a profile, or else of a recording
  std::optional<std::string> rows;
  std::string recording;
  std::string rig;
  std::string out;
  std::size_t moments = 6;
  std::uint64_t first = 0;
  std::vector<std::string> figures;
  std::string config;  // with the servos of `servos` instead of pictures
  std::vector<std::string> servos;
  bool check = false;
  FaceOptions face;
};

std::string Format(const char* format, double value) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::vector<Figure> FiguresFor(const RecordingFigures& figures,
                               const std::vector<std::string>& more) {
  std::vector<Figure> all{
      {std::to_string(figures.frames), "frames"},
      {Format("%.1f", figures.fps), "frames a second"},
      {Format("%.1f ms", figures.latency_p50_ms), "latency, median"},
      {Format("%.1f ms", figures.latency_p99_ms), "latency, 99 %"},
      {std::to_string(figures.missed), "frames dropped"},
      {std::to_string(figures.losses), "face losses"},
      {std::to_string(figures.blinks), "blinks"},
  };
  for (const std::string& figure : more) {
    const std::size_t equals = figure.find('=');
    if (equals == std::string::npos) {
      throw app::BadInput("--figure " + figure + ": LABEL=VALUE would be right");
    }
    all.push_back({figure.substr(equals + 1), figure.substr(0, equals)});
  }
  return all;
}

// The poses that may be drawn: those that followed a face, of pictures that the video has in this
// order.
std::vector<RigPose> Drawable(const std::vector<RecordedPose>& recording, std::uint64_t first) {
  // The service fades a face in; until then the character is between two poses.
  constexpr std::chrono::milliseconds kFadeIn{500};
  std::vector<RigPose> poses;
  Time found{};
  bool tracking = false;
  for (const RecordedPose& recorded : recording) {
    if (recorded.tracking && !tracking) found = recorded.pose.captured;
    tracking = recorded.tracking;
    if (!tracking || recorded.pose.captured < found + kFadeIn) continue;
    if (first == 0 || recorded.pose.seq < first) poses.push_back(recorded.pose);
  }
  if (poses.empty()) throw app::BadInput("the recording has no frame in which a face was followed");
  return poses;
}

cv::Mat PictureOf(const Frame& frame) {
  if (frame.image.format != PixelFormat::kBgr24)
    throw app::Failure("the video's pictures are not BGR");
  const Plane& plane = frame.image.planes[0];
  // OpenCV has no read-only view; the copy is what is kept.
  return cv::Mat(frame.image.height_px, frame.image.width_px, CV_8UC3,
                 const_cast<std::uint8_t*>(plane.data),
                 static_cast<std::size_t>(plane.stride_bytes))
      .clone();
}

// Plays the video, follows the face as the service did, and keeps the pictures of the moments.
std::vector<Moment> TakeMoments(const std::vector<RigPose>& poses, const std::vector<Pick>& picks,
                                double start_s, FaceReader& reader) {
  std::vector<Moment> moments;
  for (auto pick = picks.begin(); pick != picks.end();) {
    const auto frame = reader.Next();
    if (!frame) break;
    const auto face = reader.Track();
    const RigPose& pose = poses[pick->index];
    if (frame->seq < pose.seq) continue;
    Moment moment;
    moment.caption = pick->caption;
    moment.frame = pose.seq;
    moment.time_s =
        std::chrono::duration<double>(pose.captured.time_since_epoch()).count() - start_s;
    moment.picture = PictureOf(*frame);
    if (face) moment.landmarks = *face;
    moment.pose = pose;
    moments.push_back(std::move(moment));
    ++pick;
  }
  if (moments.size() < picks.size()) {
    throw app::BadInput(
        "the video ends before frame " + std::to_string(poses[picks[moments.size()].index].seq) +
        " of the recording; --first N says how many frames the recording shows of it");
  }
  return moments;
}

void WritePng(const cv::Mat& picture, OutputFile& out) {
  out.Write(EncodePng(picture));
  out.Commit();
}

void DrawRecording(const SheetOptions& options) {
  const Rig rig = app::LoadRig(options.rig);
  const std::vector<RecordedPose> recording = ReadRecording(options.recording, rig);
  const std::vector<Figure> figures = FiguresFor(FiguresOf(recording, rig), options.figures);
  const std::vector<RigPose> poses = Drawable(recording, options.first);
  const std::vector<Pick> picks = PickMoments(rig, poses, options.moments);
  OutputFile out(options.out);
  FaceReader reader(options.face);
  const double start_s =
      std::chrono::duration<double>(recording.front().pose.captured.time_since_epoch()).count();
  const std::vector<Moment> moments = TakeMoments(poses, picks, start_s, reader);
  WritePng(DrawSheet("what the camera saw, and what the character was told over the wire", figures,
                     rig, moments),
           out);
  for (const Figure& figure : figures)
    std::printf("  %-18s %s\n", figure.label.c_str(), figure.value.c_str());
}

void DrawServos(const SheetOptions& options) {
  if (options.recording.empty() || options.config.empty())
    throw app::BadInput("--servo needs a RECORDING and the service's --config");
  const ServoSheet sheet = SheetOfServos({options.recording, options.config, options.servos});
  OutputFile out(options.out);
  WritePng(sheet.picture, out);
  std::fputs(sheet.table.c_str(), stdout);
  if (!options.check || sheet.strayed.empty()) return;
  std::string all;
  for (const std::string& servo : sheet.strayed) all += (all.empty() ? "" : "; ") + servo;
  throw app::Failure("not every servo followed: " + all);
}

void DrawSheetFile(const SheetOptions& options) {
  if (!options.servos.empty()) return DrawServos(options);
  if (!options.training.empty()) {
    OutputFile out(options.out);
    WritePng(SheetOfTraining(options.training, options.rows), out);
    return;
  }
  if (options.recording.empty() || options.face.input.empty() || options.rig.empty())
    throw app::BadInput(
        "a RECORDING with --video and --rig is needed, or one with --config and --servo, or "
        "--training F.profile");
  DrawRecording(options);
}

}  // namespace

void AddSheet(CLI::App& facewire) {
  auto options = std::make_shared<SheetOptions>();
  CLI::App* command = facewire.add_subcommand(
      "sheet",
      "Draw a contact sheet: moments of a video beside what the character was told, what servos "
      "did beside what they were told, or the rows of a training set beside what the others "
      "predict");
  CLI::Option* recording = command->add_option(
      "RECORDING", options->recording, "What `facewire monitor --csv` wrote of the service's line");
  CLI::Option* video =
      command->add_option("--video", options->face.input, "The video that the service saw");
  CLI::Option* rig = command->add_option("--rig", options->rig, "The rig that the service drove");
  CLI::Option* training =
      command
          ->add_option("--training", options->training,
                       "Instead of a recording: the profile whose example pairs to draw")
          ->excludes(recording)
          ->excludes(video)
          ->excludes(rig);
  command
      ->add_option("--rows", options->rows,
                   "A:B, rows A to B of the training, from 1; else all, or the worst of too many")
      ->needs(training);
  command->add_option("--out", options->out, "The PNG to write")->required();
  command->add_option("--moments", options->moments, "Rows of the sheet, at most")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  command->add_option("--first", options->first,
                      "Only look at so many frames: where a looped video turned round");
  command->add_option("--figure", options->figures,
                      "LABEL=VALUE: one more figure for the sheet's head; may be repeated");
  CLI::Option* servos =
      command
          ->add_option("--servo", options->servos,
                       "NAME=TRACE:INDEX, as jaw=mouth.csv:0: instead of pictures, draw what the "
                       "rig's servo NAME was to do and did, by row INDEX of a simulated bus's "
                       "trace; may be repeated")
          ->excludes(video)
          ->excludes(rig)
          ->excludes(training);
  command
      ->add_option("--config", options->config,
                   "The service's configuration, with the servos' buses")
      ->needs(servos);
  command
      ->add_flag("--check", options->check,
                 "Fail when a servo did not follow, or had torque at the end")
      ->needs(servos);
  AddFaceOptions(*command, options->face);
  command->callback([options] { DrawSheetFile(*options); });
}

}  // namespace facewire::tools
