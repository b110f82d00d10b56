#ifndef FACEWIRE_APP_NETWORKS_H_
#define FACEWIRE_APP_NETWORKS_H_

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/track/tracker.h"

namespace facewire::app {

// The contents of the network files that a tracker needs; not needed any more once it is loaded.
struct Networks {
  std::vector<std::byte> detector;
  std::vector<std::byte> landmarks;
  track::NetworkFiles files() const noexcept { return {detector, landmarks}; }
};

// Reads face_detection_short_range.tflite and the landmark network of the model from a folder.
// Every file must be the one that facewire was made for, byte by byte (npm package
// @mediapipe/face_mesh 0.4.1657299874, which tools/setup unpacks). Throws BadInput, naming the
// file, when one is missing, cannot be read, has another size, or another SHA-256.
Networks LoadNetworks(const std::filesystem::path& folder, track::Model model);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_NETWORKS_H_
