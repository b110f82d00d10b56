#ifndef FACEWIRE_APP_FILE_CALLS_H_
#define FACEWIRE_APP_FILE_CALLS_H_

#include <sys/types.h>

#include <cstddef>

namespace facewire::app {

// The calls by which files are kept, as narrow as they are: each answers and sets errno exactly as
// its namesake of POSIX does. Tests put a disk of their own here, which is full, read-only, or
// loses power between any two calls.
class FileCalls {
 public:
  virtual ~FileCalls() = default;
  virtual int Open(const char* path, int flags, mode_t mode) = 0;
  // As mkostemp with O_CLOEXEC: the last six characters of `pattern` become the file's own.
  virtual int OpenTemporary(char* pattern) = 0;
  virtual ssize_t Write(int fd, const void* bytes, std::size_t count) = 0;
  virtual int ChangeMode(int fd, mode_t mode) = 0;
  virtual int Sync(int fd) = 0;
  virtual int Close(int fd) = 0;
  virtual int Rename(const char* from, const char* to) = 0;
  virtual int Unlink(const char* path) = 0;
  virtual int Exists(const char* path) = 0;  // lstat: 0, or -1 and errno
};

// The running kernel's.
FileCalls& LinuxFiles() noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_FILE_CALLS_H_
