#ifndef FACEWIRE_TESTS_APP_FAKE_DISK_H_
#define FACEWIRE_TESTS_APP_FAKE_DISK_H_

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/file_calls.h"

namespace facewire::app {

// A disk that forgets everything it was not told to keep: bytes until their file is synced, names
// until their folder is. It can fail at any call, or lose power before any.
class FakeDisk final : public FileCalls {
 public:
  using Files = std::map<std::string, std::string>;  // names and contents

  // A file that has been there for long.
  void Hold(const std::string& path, const std::string& content) {
    names_[path] = kept_names_[path] = static_cast<int>(nodes_.size());
    nodes_.push_back({content, content});
  }
  // The n'th call from now on (from 0), and `count - 1` after it, fail with `error`.
  void FailAt(int n, int error, int count = 1) {
    fail_from_ = calls_ + n;
    fail_to_ = fail_from_ + count;
    error_ = error;
  }
  void ReadOnly() { FailAt(0, EROFS, std::numeric_limits<int>::max() / 2); }
  void Repair() { fail_from_ = fail_to_ = -1; }
  // Before the n'th call from now on; nothing happens afterwards, the program is gone.
  void LosePowerBefore(int n) { power_until_ = calls_ + n; }
  int calls() const { return calls_; }

  // As programs see it now.
  Files Seen() const {
    Files files;
    for (const auto& [path, node] : names_) files[path] = At(node).bytes;
    return files;
  }
  // Everything that may be found after a loss of power at this moment: each change of a name that
  // was not synced may have come through or not, and of bytes nothing, a part, or all.
  std::vector<Files> Survivors() const {
    std::vector<Files> all;
    for (unsigned subset = 0; subset < (1U << changes_.size()); ++subset) {
      std::map<std::string, int> names = kept_names_;
      for (std::size_t i = 0; i < changes_.size(); ++i) {
        if ((subset >> i & 1U) != 0) Apply(changes_[i], names);
      }
      for (int part = 0; part < 4; ++part) {
        Files files;
        for (const auto& [path, node] : names) files[path] = Remains(At(node), part);
        all.push_back(files);
      }
    }
    return all;
  }

  int Open(const char* path, int flags, mode_t /*mode*/) override {
    if (!Works(O_WRONLY == (flags & O_ACCMODE))) return -1;
    if ((flags & O_DIRECTORY) != 0) return Describe(kFolder);
    if (!names_.contains(path)) {
      if ((flags & O_CREAT) == 0) return Fail(ENOENT);
      Create(path);
    }
    return Describe(names_[path]);
  }
  int OpenTemporary(char* pattern) override {
    if (!Works(true)) return -1;
    std::memcpy(pattern + std::strlen(pattern) - 6, "abcdef", 6);
    Create(pattern);
    return Describe(names_[pattern]);
  }
  ssize_t Write(int fd, const void* bytes, std::size_t count) override {
    if (!Works(true)) return -1;
    const std::size_t taken = std::min<std::size_t>(count, 64);  // never all at once
    Of(fd).bytes.append(static_cast<const char*>(bytes), taken);
    return static_cast<ssize_t>(taken);
  }
  int ChangeMode(int /*fd*/, mode_t /*mode*/) override { return Works(true) ? 0 : -1; }
  int Sync(int fd) override {
    if (!Works(false)) return -1;
    if (open_[static_cast<std::size_t>(fd)] != kFolder) {
      Of(fd).kept = Of(fd).bytes;
      return 0;
    }
    kept_names_ = names_;
    changes_.clear();
    return 0;
  }
  int Close(int /*fd*/) override { return Works(false) ? 0 : -1; }
  int Rename(const char* from, const char* to) override {
    if (!Works(true)) return -1;
    Change({from, to, names_[from]});
    return 0;
  }
  int Unlink(const char* path) override {
    if (!Works(true)) return -1;
    if (!names_.contains(path)) return Fail(ENOENT);
    Change({path, "", 0});
    return 0;
  }
  int Exists(const char* path) override {
    if (!Works(false)) return -1;
    return names_.contains(path) ? 0 : Fail(ENOENT);
  }

 private:
  static constexpr int kFolder = -1;
  struct Node {
    std::string bytes, kept;
  };
  // A name that goes, comes, or becomes another at once.
  struct NameChange {
    std::string from, to;
    int node;
  };

  const Node& At(int node) const { return nodes_[static_cast<std::size_t>(node)]; }
  Node& Of(int fd) { return nodes_[static_cast<std::size_t>(open_[static_cast<std::size_t>(fd)])]; }
  static std::string Remains(const Node& node, int part) {
    if (part == 0) return node.kept;
    return node.bytes == node.kept ? node.kept
                                   : node.bytes.substr(0, node.bytes.size() * (part - 1) / 2);
  }
  static void Apply(const NameChange& change, std::map<std::string, int>& names) {
    if (!change.from.empty()) names.erase(change.from);
    if (!change.to.empty()) names[change.to] = change.node;
  }
  void Change(const NameChange& change) {
    Apply(change, names_);
    changes_.push_back(change);
  }
  void Create(const std::string& path) {
    nodes_.emplace_back();
    Change({"", path, static_cast<int>(nodes_.size()) - 1});
  }
  int Describe(int node) {
    open_.push_back(node);
    return static_cast<int>(open_.size()) - 1;
  }
  static int Fail(int error) {
    errno = error;
    return -1;
  }
  // A read-only disk still reads.
  bool Works(bool changes) {
    const int call = calls_++;
    if (call >= power_until_) return Fail(EIO) == 0;
    const bool fails = call >= fail_from_ && call < fail_to_ && (changes || error_ != EROFS);
    return !fails || Fail(error_) == 0;
  }

  std::vector<Node> nodes_;
  std::vector<int> open_;
  std::map<std::string, int> names_, kept_names_;
  std::vector<NameChange> changes_;
  int calls_ = 0;
  int fail_from_ = -1;
  int fail_to_ = -1;
  int error_ = 0;
  int power_until_ = std::numeric_limits<int>::max();
};

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_FAKE_DISK_H_
