#ifndef FACEWIRE_TOOLS_FACEWIRE_OUTPUT_FILE_H_
#define FACEWIRE_TOOLS_FACEWIRE_OUTPUT_FILE_H_

#include <cstdio>
#include <string>
#include <string_view>

namespace facewire::tools {

// A file that appears whole or not at all. What is written goes to a temporary file in the same
// folder, which Commit renames; without Commit, and also when SIGINT, SIGTERM or SIGHUP ends the
// program, it is removed and an older file of the name stays as it was. A path that exists and is
// no regular file
// (/dev/stdout, a FIFO) is written to directly. One at a time in a process: the signal handler
// knows one.
class OutputFile {
 public:
  // Throws BadInput when the path cannot be written to.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Throws Failure when the disk does not take it.
  void Write(std::string_view bytes);
  // Makes the file appear, and last through a power cut. Throws Failure. Nothing may be written
  // after it.
  void Commit();

 private:
  [[noreturn]] void Fail(const char* doing) const;

  std::string path_;
  std::string temporary_;  // empty when writing directly
  std::FILE* file_ = nullptr;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_OUTPUT_FILE_H_
