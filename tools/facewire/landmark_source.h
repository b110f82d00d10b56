#ifndef FACEWIRE_TOOLS_FACEWIRE_LANDMARK_SOURCE_H_
#define FACEWIRE_TOOLS_FACEWIRE_LANDMARK_SOURCE_H_

#include <memory>
#include <optional>

#include "tools/facewire/face_reader.h"
#include "tools/facewire/landmark_file.h"

namespace facewire::tools {

// What was seen of a face, picture by picture, wherever that comes from.
class LandmarkSource {
 public:
  virtual ~LandmarkSource() = default;
  // nullopt at the end of a recording. Throws BadInput, Failure.
  virtual std::optional<Sighting> Next() = 0;
  // The caller does not believe the last face: whoever follows one forgets where it was.
  virtual void Lose() = 0;
};

// Of a video or a camera, tracked; of a landmark file (landmark_file.h), read. Throws BadInput,
// Failure.
std::unique_ptr<LandmarkSource> OpenLandmarks(const FaceOptions& options);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_LANDMARK_SOURCE_H_
