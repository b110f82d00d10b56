#ifndef FACEWIRE_TESTS_TOOLS_FACEWIRE_RUN_H_
#define FACEWIRE_TESTS_TOOLS_FACEWIRE_RUN_H_

#include <filesystem>
#include <string>
#include <vector>

namespace facewire::tools {

struct Outcome {
  int code = -1;  // exit code; -1 when a signal ended it
  std::string out;
  std::string err;
};

// Runs the real facewire with these arguments, to its end.
Outcome RunFacewire(const std::vector<std::string>& arguments);

// A folder of its own for a test, removed at the end.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string Write(const std::string& name, const std::string& contents) const;
  std::string Read(const std::string& name) const;
  std::size_t Files() const;

 private:
  std::filesystem::path folder_;
};

// The first frames of the footage, as a video of its own.
std::string ShortClip(const Scratch& scratch, int frames);

}  // namespace facewire::tools

#endif  // FACEWIRE_TESTS_TOOLS_FACEWIRE_RUN_H_
