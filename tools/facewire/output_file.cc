#include "tools/facewire/output_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "app/error.h"

namespace facewire::tools {
namespace {

// What a signal must remove. Set while no signal can see half of it: the flag comes last.
std::array<char, PATH_MAX> doomed{};
volatile std::sig_atomic_t has_doomed = 0;

// Only calls that POSIX allows in a signal handler. The signal then ends the program as it would
// have.
extern "C" void RemoveAndDie(int signal) {
  if (has_doomed != 0) unlink(doomed.data());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void RemoveOnSignal(const std::string& path) {
  std::copy(path.begin(), path.end(), doomed.begin());
  doomed[path.size()] = '\0';
  has_doomed = 1;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction current {};
    // A command that ends in its own way on a signal (a live camera), or a parent that ignores it
    // (nohup), keeps its say.
    if (sigaction(signal, nullptr, &current) == 0 && current.sa_handler == SIG_DFL) {
      std::signal(signal, RemoveAndDie);
    }
  }
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path) {
  const auto refuse = [&](const std::string& why) {
    throw app::BadInput("cannot write " + path_ + ": " + why);
  };
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) refuse("it is a folder, a file is needed");
  if (exists && !S_ISREG(status.st_mode)) {
    file_ = std::fopen(path.c_str(), "we");
    if (file_ == nullptr) refuse(std::strerror(errno));
    return;
  }
  if (exists && access(path.c_str(), W_OK) != 0) refuse(std::strerror(errno));
  temporary_ = path + ".XXXXXX";
  if (temporary_.size() >= doomed.size()) refuse("the path is too long");
  const int fd = mkstemp(temporary_.data());
  if (fd < 0) {
    temporary_.clear();
    refuse(errno == ENOENT ? "its folder does not exist" : std::strerror(errno));
  }
  RemoveOnSignal(temporary_);
  // mkstemp keeps others out; a result has the permissions of any new file, or of the one it
  // replaces.
  const mode_t mask = umask(0);
  umask(mask);
  fchmod(fd, exists ? status.st_mode & 07777 : 0666 & ~mask);
  file_ = fdopen(fd, "w");
  if (file_ == nullptr) {
    close(fd);
    unlink(temporary_.c_str());
    refuse(std::strerror(errno));
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
  has_doomed = 0;
}

void OutputFile::Write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) Fail("writing");
}

void OutputFile::Commit() {
  if (std::fflush(file_) != 0) Fail("writing");
  // A pipe or a terminal has nothing to sync and says so with EINVAL.
  if (!temporary_.empty() && fsync(fileno(file_)) != 0) Fail("writing");
  const int closed = std::fclose(file_);
  file_ = nullptr;
  if (closed != 0) Fail("closing");
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) Fail("renaming");
  temporary_.clear();
  has_doomed = 0;
}

void OutputFile::Fail(const char* doing) const {
  throw app::Failure(std::string(doing) + " " + path_ + ": " + std::strerror(errno));
}

}  // namespace facewire::tools
