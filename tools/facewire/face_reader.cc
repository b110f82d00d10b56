#include "tools/facewire/face_reader.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "app/devices.h"
#include "app/error.h"
#include "app/networks.h"

namespace facewire::tools {
namespace {

// A camera delivers many frames in this time; silence for longer means that something is wrong.
constexpr std::chrono::seconds kSilence{5};

}  // namespace

void AddFaceOptions(CLI::App& command, FaceOptions& options) {
  command
      .add_option("--model", options.model, "attention: exact lids, lips and irises; mesh: lighter")
      ->check(CLI::IsMember({"attention", "mesh"}))
      ->capture_default_str();
  command.add_option(
      "--networks", options.networks,
      "Folder of the .tflite files; else FACEWIRE_NETWORKS, else the installed ones");
}

std::filesystem::path NetworksFolder(const std::string& chosen) {
  if (!chosen.empty()) return chosen;
  if (const char* set = std::getenv("FACEWIRE_NETWORKS"); set != nullptr && *set != '\0')
    return set;
  const std::filesystem::path installed = FACEWIRE_INSTALLED_SHARE "/networks";
  const std::filesystem::path unpacked = FACEWIRE_ASSETS "/networks";
  return !std::filesystem::exists(installed) && std::filesystem::exists(unpacked) ? unpacked
                                                                                  : installed;
}

bool IsLive(const std::string& input) {
  return input.starts_with("v4l2:") || input.starts_with("libcamera:");
}

FaceReader::FaceReader(const FaceOptions& options) : name_(options.input) {
  LoadNetworks(options);
  app::CameraOptions camera;
  camera.pace = hal::Pace::kFast;
  camera_ = app::MakeCamera(name_, camera, clock_);
  app::StartCamera(*camera_, name_);
}

FaceReader::~FaceReader() {
  if (held_) camera_->Release(*held_);
}

void FaceReader::LoadNetworks(const FaceOptions& options) {
  track::TrackerConfig config;
  if (options.model == "mesh") config.model = track::Model::kMesh;
  const std::filesystem::path folder = NetworksFolder(options.networks);
  const app::Networks networks = app::LoadNetworks(folder, config.model);
  const std::size_t size = track::Tracker::RequiredBytes(config.model);
  memory_ = std::make_unique<std::byte[]>(size);
  arena_.emplace(std::span(memory_.get(), size));
  const auto loaded = tracker_.Load(config, networks.files(), *arena_);
  if (!loaded)
    throw app::Failure("loading the networks in " + folder.string() + ": " + Name(loaded.error()));
}

std::optional<Frame> FaceReader::Next() {
  if (held_) camera_->Release(*std::exchange(held_, std::nullopt));
  const auto frame = camera_->Acquire(kSilence);
  if (frame) return held_ = *frame;
  if (frame.error() == Errc::kEnd) return std::nullopt;
  throw app::Failure(app::DescribeCameraError(frame.error(), *camera_, name_));
}

Result<Landmarks> FaceReader::Track() {
  auto face = tracker_.Update(*held_);
  if (!face && face.error() != Errc::kNoFace) {
    throw app::Failure("tracking in " + name_ + ": " + Name(face.error()));
  }
  return face;
}

}  // namespace facewire::tools
