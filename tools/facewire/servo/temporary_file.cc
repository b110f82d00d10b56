#include "tools/facewire/servo/temporary_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "app/error.h"

namespace facewire::tools {
namespace {

class TemporaryFile {
 public:
  TemporaryFile(const std::filesystem::path& folder, const std::string& text)
      : path_((folder / "facewire-check-XXXXXX").string()) {
    const int fd = ::mkstemp(path_.data());
    if (fd < 0) throw app::Failure(path_ + ": " + std::strerror(errno));
    ::close(fd);
    if (!(std::ofstream(path_, std::ios::binary) << text).flush()) {
      ::unlink(path_.c_str());
      throw app::Failure("writing " + path_ + ": " + std::strerror(errno));
    }
  }
  ~TemporaryFile() { ::unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

void CheckAsFile(const std::filesystem::path& folder, const std::string& text,
                 const std::string& name,
                 const std::function<void(const std::filesystem::path&)>& check) {
  const TemporaryFile copy(folder, text);
  try {
    check(copy.path());
  } catch (const app::BadInput& error) {
    std::string what = error.what();
    for (std::size_t at = 0; (at = what.find(copy.path(), at)) != std::string::npos;) {
      what.replace(at, copy.path().size(), name);
      at += name.size();
    }
    throw app::BadInput(what);
  }
}

}  // namespace facewire::tools
