#ifndef FACEWIRE_TOOLS_FACEWIRE_LANDMARK_FILE_H_
#define FACEWIRE_TOOLS_FACEWIRE_LANDMARK_FILE_H_

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "core/landmarks.h"

namespace facewire::tools {

// What was seen in one picture.
struct Sighting {
  std::uint64_t frame = 0;
  std::int64_t t_us = 0;          // since the recording's first picture
  std::optional<Landmarks> face;  // none: no face was found
};

// A line of a landmark file, with its end:
//   {"frame":0,"t_us":0,"state":"tracking","presence":0.99,"width":640,"height":480,
//    "landmarks":[[x,y,z],...]}
// in pixels of that picture, thousandths; without a face the state is "searching", there is no
// picture size and the landmarks are null.
std::string LandmarkLine(const Sighting& sighting);

// True when the name ends as a landmark file's does (.jsonl).
bool IsLandmarkFile(const std::string& path);

// Reads a file of such lines, one after the other. Keys may come in any order, unknown ones are
// passed over; "state" is not needed and "presence" is 1 when it is missing.
class LandmarkFile {
 public:
  // Throws BadInput.
  explicit LandmarkFile(const std::string& path);
  // nullopt at the end. Throws BadInput, with the line: not such a line, another number of
  // landmarks than 468 or 478, no picture size, frames or times that do not count up.
  std::optional<Sighting> Next();

 private:
  std::string path_;
  std::ifstream file_;
  std::size_t line_ = 0;
  std::optional<Sighting> last_;  // without its face
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_LANDMARK_FILE_H_
