#include "tools/facewire/face_reader.h"

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "app/devices.h"
#include "app/error.h"
#include "app/network_files.h"

namespace facewire::tools {
namespace {

// A camera delivers several frames in this time; silence for longer means that something is wrong.
constexpr std::chrono::seconds kSilence{5};

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
  const std::filesystem::path installed = FACEWIRE_INSTALLED_NETWORKS;
  const std::filesystem::path unpacked = FACEWIRE_ASSETS "/networks";
  return !std::filesystem::exists(installed) && std::filesystem::exists(unpacked) ? unpacked : installed;
}

bool IsLive(const std::string& input) {
  return input.starts_with("v4l2:") || input.starts_with("libcamera:");
}

FaceReader::FaceReader(const FaceOptions& options) : name_(options.input) {
  Load(options);
}

}  // namespace facewire::tools
