#include "app/stop_latch.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <string_view>

namespace facewire::app {
namespace {

// For whoever finds the file.
constexpr std::string_view kContent = "emergency stop; `facewire release` ends it\n";
constexpr mode_t kMode = 0644;

}  // namespace

StopLatch::StopLatch(const std::vector<std::string>& folders, FileCalls& files) : files_(files) {
  for (const std::string& folder : folders) {
    if (!folder.empty()) paths_.push_back(folder + "/stopped");
  }
  reason_.reserve(512);
}

void StopLatch::Blame(const std::string& path, const char* what) noexcept {
  const int error = errno;
  if (!reason_.empty()) reason_ += "; ";
  reason_ += path;
  reason_ += what;
  reason_ += std::strerror(error);
}

bool StopLatch::Engaged() noexcept {
  reason_.clear();
  bool engaged = false;
  for (const std::string& path : paths_) {
    if (files_.Exists(path.c_str()) == 0) {
      engaged = true;
    } else if (errno != ENOENT && errno != ENOTDIR) {
      engaged = true;
      Blame(path, ": cannot be looked at: ");
    }
  }
  return engaged;
}

bool StopLatch::Engage() noexcept {
  reason_.clear();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (Make(paths_[i])) return i == 0;
  }
  return paths_.empty();
}

// The file is the memory from the moment it exists; its content may come or not.
bool StopLatch::Make(const std::string& path) noexcept {
  const int file = files_.Open(path.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, kMode);
  if (file < 0) {
    Blame(path, ": cannot be made: ");
    return false;
  }
  (void)files_.Write(file, kContent.data(), kContent.size());  // a full disk takes an empty file
  (void)files_.Sync(file);
  (void)files_.Close(file);
  if (SyncFolder(path)) return true;
  Blame(path, ": may not outlast a loss of power: ");
  return false;
}

bool StopLatch::Release() noexcept {
  reason_.clear();
  for (const std::string& path : paths_) {
    if (files_.Unlink(path.c_str()) != 0 && errno != ENOENT && errno != ENOTDIR) {
      // A disk that cannot be written may well not hold the file.
      const int error = errno;
      if (files_.Exists(path.c_str()) != 0 && (errno == ENOENT || errno == ENOTDIR)) continue;
      errno = error;
      Blame(path, ": cannot be removed: ");
    } else {
      (void)SyncFolder(path);
    }
  }
  return reason_.empty();
}

// A file is on the disk when its folder is. (After a release that matters little: a loss of power
// brings the stop back, which is the safe side.)
bool StopLatch::SyncFolder(const std::string& path) noexcept {
  const std::string folder = path.substr(0, path.rfind('/'));
  const int descriptor = files_.Open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC, 0);
  if (descriptor < 0) return false;
  const bool synced = files_.Sync(descriptor) == 0 || errno == EINVAL;  // some keep no folders
  const int error = errno;
  (void)files_.Close(descriptor);
  errno = error;
  return synced;
}

}  // namespace facewire::app
