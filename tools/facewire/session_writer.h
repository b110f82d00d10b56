#ifndef FACEWIRE_TOOLS_FACEWIRE_SESSION_WRITER_H_
#define FACEWIRE_TOOLS_FACEWIRE_SESSION_WRITER_H_

#include <string>
#include <vector>

#include "tools/facewire/output_file.h"
#include "tools/facewire/session.h"

namespace facewire::tools {

// Writes a session, in cm with five decimals; as JSON lines when the path ends in .jsonl.
//   CSV:  frame,t_us, then NAME_x,NAME_y,NAME_z for each marker; a marker that was not seen has
//         empty fields
//   JSON: {"frame":0,"t_us":0,"markers":{"NAME":[x,y,z],..}}; null for one that was not seen
class SessionWriter {
 public:
  // Throws BadInput for a path that cannot be written to, or that ends in neither.
  explicit SessionWriter(const std::string& path);
  // `frame` has points; `names` are theirs, the same every time.
  void Write(const SessionFrame& frame, const std::vector<std::string>& names);
  void Commit() { out_.Commit(); }

 private:
  void WriteCsv(const SessionFrame& frame, const std::vector<std::string>& names);
  void WriteJson(const SessionFrame& frame, const std::vector<std::string>& names);

  OutputFile out_;
  bool json_;
  bool has_header_ = false;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SESSION_WRITER_H_
