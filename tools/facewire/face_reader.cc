#include "tools/facewire/face_reader.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "app/error.h"
#include "hal/replay/replay_camera.h"
#include "hal/v4l2/v4l2_camera.h"

namespace facewire::tools {
namespace {

// A camera delivers many frames in this time; silence for longer means that something is wrong.
constexpr std::chrono::seconds kSilence{5};

track::Model ModelOf(const std::string& name) {
  return name == "mesh" ? track::Model::kMesh : track::Model::kAttention;
}

std::vector<std::byte> ReadNetwork(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw app::BadInput("there is no network " + file.string() +
                        "; run tools/setup, or name the networks' folder with --networks");
  }
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  return {first, first + bytes.size()};
}

std::unique_ptr<hal::Camera> MakeCamera(const std::string& input, hal::Clock& clock) {
  if (input.starts_with("libcamera:")) {
    throw app::BadInput(input + ": libcamera is not built in; a camera that the kernel shows as /dev/videoN "
                        "works as v4l2:/dev/videoN");
  }
  if (input.starts_with("v4l2:")) {
    hal::v4l2::V4l2Config config;
    config.device = input.substr(input.find(':') + 1);
    return std::make_unique<hal::v4l2::V4l2Camera>(config, clock);
  }
  hal::replay::ReplayConfig config;
  config.path = input;
  config.pace = hal::Pace::kFast;
  return std::make_unique<hal::replay::ReplayCamera>(config, clock);
}

void Start(hal::Camera& camera, const std::string& name) {
  const auto started = camera.Start();
  if (started) return;
  switch (started.error()) {
    case Errc::kNotFound:
      throw app::BadInput("there is no " + name);
    case Errc::kPermission:
      throw app::BadInput("no permission to read " + name + "; `facewire doctor` says what is missing");
    case Errc::kBusy:
      throw app::BadInput(name + " is in use by another program; end that one first");
    case Errc::kUnsupported:
      throw app::BadInput(IsLive(name) ? name + " offers no picture format that facewire reads"
                                       : name + " is not a video that can be played");
    default:
      throw app::Failure("opening " + name + ": " + Name(started.error()));
  }
}

}  // namespace

void AddFaceOptions(CLI::App& command, FaceOptions& options) {
  command.add_option("--model", options.model, "attention: exact lids, lips and irises; mesh: lighter")
      ->check(CLI::IsMember({"attention", "mesh"}))
      ->capture_default_str();
  command.add_option("--networks", options.networks,
                     "Folder of the .tflite files; else FACEWIRE_NETWORKS, else the installed ones");
}

std::filesystem::path NetworksFolder(const std::string& chosen) {
  if (!chosen.empty()) return chosen;
  if (const char* set = std::getenv("FACEWIRE_NETWORKS"); set != nullptr && *set != '\0') return set;
  const std::filesystem::path installed = FACEWIRE_INSTALLED_SHARE "/networks";
  const std::filesystem::path unpacked = FACEWIRE_ASSETS "/networks";
  return !std::filesystem::exists(installed) && std::filesystem::exists(unpacked) ? unpacked : installed;
}

bool IsLive(const std::string& input) {
  return input.starts_with("v4l2:") || input.starts_with("libcamera:");
}

FaceReader::FaceReader(const FaceOptions& options) : name_(options.input) {
  LoadNetworks(options);
  camera_ = MakeCamera(name_, clock_);
  Start(*camera_, name_);
}

FaceReader::~FaceReader() {
  if (held_) camera_->Release(*held_);
}

void FaceReader::LoadNetworks(const FaceOptions& options) {
  const std::filesystem::path folder = NetworksFolder(options.networks);
  const track::Model model = ModelOf(options.model);
  const auto detector = ReadNetwork(folder / "face_detection_short_range.tflite");
  const auto landmarks = ReadNetwork(
      folder / (model == track::Model::kMesh ? "face_landmark.tflite" : "face_landmark_with_attention.tflite"));
  const std::size_t size = track::Tracker::RequiredBytes(model);
  memory_ = std::make_unique<std::byte[]>(size);
  arena_.emplace(std::span(memory_.get(), size));
  track::TrackerConfig config;
  config.model = model;
  const auto loaded = tracker_.Load(config, {detector, landmarks}, *arena_);
  if (loaded) return;
  if (loaded.error() == Errc::kCorrupt) {
    throw app::BadInput("the networks in " + folder.string() + " are damaged; delete them and run tools/setup");
  }
  throw app::Failure("loading the networks in " + folder.string() + ": " + Name(loaded.error()));
}

std::optional<Frame> FaceReader::Next() {
  if (held_) camera_->Release(*std::exchange(held_, std::nullopt));
  const auto frame = camera_->Acquire(kSilence);
  if (frame) return held_ = *frame;
  switch (frame.error()) {
    case Errc::kEnd:
      return std::nullopt;
    case Errc::kTimeout:
      throw app::Failure(name_ + " has sent no picture for " + std::to_string(kSilence.count()) + " s");
    case Errc::kDisconnected:
      throw app::Failure(name_ + " is gone");
    default:
      throw app::Failure("reading " + name_ + ": " + Name(frame.error()));
  }
}

Result<Landmarks> FaceReader::Track() {
  auto face = tracker_.Update(*held_);
  if (!face && face.error() != Errc::kNoFace) {
    throw app::Failure("tracking in " + name_ + ": " + Name(face.error()));
  }
  return face;
}

}  // namespace facewire::tools
