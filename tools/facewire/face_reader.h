#ifndef FACEWIRE_TOOLS_FACEWIRE_FACE_READER_H_
#define FACEWIRE_TOOLS_FACEWIRE_FACE_READER_H_

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/landmarks.h"
#include "core/track/tracker.h"
#include "hal/camera.h"
#include "hal/system_clock.h"

namespace CLI {
class App;
}

namespace facewire::tools {

// What a command that follows a face lets the person choose.
struct FaceOptions {
  std::string input;  // a video file, "v4l2:/dev/videoN", "libcamera:N" or a landmark file (.jsonl)
  std::string model = "attention";  // or "mesh"
  std::string networks;             // folder; empty: found as NetworksFolder says
};
// Adds --model and --networks.
void AddFaceOptions(CLI::App& command, FaceOptions& options);

// Where the networks are: `chosen`, else the environment's FACEWIRE_NETWORKS, else the installed
// ones, else those that tools/setup unpacked beside the sources. Whether files are there is for the
// reader.
std::filesystem::path NetworksFolder(const std::string& chosen);

bool IsLive(const std::string& input);

// The pictures of an input with what the tracker found in them, one after the other: a file as fast
// as possible and without gaps, a camera as it delivers.
class FaceReader {
 public:
  // Opens the input and loads the networks. Throws BadInput, Failure.
  explicit FaceReader(const FaceOptions& options);
  ~FaceReader();

  // The next picture, whose pixels are there until the next call; nullopt at the end of a
  // recording. Throws Failure when a camera falls silent or goes.
  std::optional<Frame> Next();
  // What is in the picture that Next gave. kNoFace.
  Result<Landmarks> Track();
  // Forgets where the face was.
  void Lose() { tracker_.Reset(); }

 private:
  void LoadNetworks(const FaceOptions& options);

  hal::SystemClock clock_;
  std::string name_;
  std::unique_ptr<std::byte[]> memory_;
  std::optional<Arena> arena_;
  track::Tracker tracker_;
  std::unique_ptr<hal::Camera> camera_;
  std::optional<Frame> held_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_FACE_READER_H_
