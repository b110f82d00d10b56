#ifndef FACEWIRE_TOOLS_FACEWIRE_SESSION_H_
#define FACEWIRE_TOOLS_FACEWIRE_SESSION_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/facewire/face_reader.h"
#include "tools/facewire/session_frame.h"

namespace CLI {
class App;
}

namespace facewire::tools {

// What a command that reads points of any origin lets the person choose.
struct SessionOptions {
  FaceOptions face;  // with the input, also when that is a marker file
  std::vector<std::string> rigid;
  std::vector<std::string> markers;
  bool unfiltered = false;
};
// Adds INPUT under the name `input`, --rigid, --markers, --unfiltered and the options of
// AddFaceOptions.
void AddSessionOptions(CLI::App& command, const std::string& input, SessionOptions& options);

// Named points over time with head motion removed: of markers, or of a face that was tracked.
class Session {
 public:
  virtual ~Session() = default;
  // nullopt at the end. Throws BadInput, Failure.
  virtual std::optional<SessionFrame> Next() = 0;
  // Of the points. Known as soon as a frame with points came.
  virtual const std::vector<std::string>& names() const = 0;
  // What the person should know of the removal of head motion, as one line, or "".
  virtual std::string Remark() const { return {}; }
};

// Markers from a .csv, .trc or .c3d, moved by the fit of --rigid; anything else as OpenVideo reads
// it, with the landmarks lm0..lm477 as points. Throws BadInput with all names that are not there.
std::unique_ptr<Session> OpenSession(const SessionOptions& options);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SESSION_H_
