#include "app/file_calls.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace facewire::app {
namespace {

class Linux final : public FileCalls {
 public:
  int Open(const char* path, int flags, mode_t mode) override { return ::open(path, flags, mode); }
  int OpenTemporary(char* pattern) override { return ::mkostemp(pattern, O_CLOEXEC); }
  ssize_t Write(int fd, const void* bytes, std::size_t count) override {
    return ::write(fd, bytes, count);
  }
  int ChangeMode(int fd, mode_t mode) override { return ::fchmod(fd, mode); }
  int Sync(int fd) override { return ::fsync(fd); }
  int Close(int fd) override { return ::close(fd); }
  int Rename(const char* from, const char* to) override { return ::rename(from, to); }
  int Unlink(const char* path) override { return ::unlink(path); }
  int Exists(const char* path) override {
    struct stat node {};
    return ::lstat(path, &node);
  }
};

}  // namespace

FileCalls& LinuxFiles() noexcept {
  static Linux calls;
  return calls;
}

}  // namespace facewire::app
