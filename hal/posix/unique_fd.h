#ifndef FACEWIRE_HAL_POSIX_UNIQUE_FD_H_
#define FACEWIRE_HAL_POSIX_UNIQUE_FD_H_

#include <unistd.h>

#include <utility>

namespace facewire::hal::posix {

// Owns one file descriptor and closes it once. -1 is "none".
class UniqueFd final {
 public:
  UniqueFd() noexcept = default;
  explicit UniqueFd(int fd) noexcept : fd_(fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(other.Release()) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    if (this != &other) Reset(other.Release());
    return *this;
  }
  UniqueFd(const UniqueFd&) = delete;
  UniqueFd& operator=(const UniqueFd&) = delete;
  ~UniqueFd() { Reset(); }

  explicit operator bool() const noexcept { return fd_ >= 0; }
  int get() const noexcept { return fd_; }
  [[nodiscard]] int Release() noexcept { return std::exchange(fd_, -1); }
  void Reset(int fd = -1) noexcept {
    // Linux frees the number even when close reports EINTR: a second try could hit somebody else's.
    if (fd_ >= 0) ::close(fd_);
    fd_ = fd;
  }

 private:
  int fd_ = -1;
};

}  // namespace facewire::hal::posix

#endif  // FACEWIRE_HAL_POSIX_UNIQUE_FD_H_
