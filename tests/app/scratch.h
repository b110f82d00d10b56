#ifndef FACEWIRE_TESTS_APP_SCRATCH_H_
#define FACEWIRE_TESTS_APP_SCRATCH_H_

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "app/error.h"

namespace facewire::app {

// A folder of this test's own, removed with everything in it.
class Scratch {
 public:
  Scratch() {
    std::string name = testing::TempDir() + "facewire-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    folder_ = name;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path operator/(const char* name) const { return folder_ / name; }

  std::filesystem::path Write(const char* name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  static std::string Read(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

 private:
  std::filesystem::path folder_;
};

// The message of the BadInput that `call` throws, which has to be one line.
template <class Call>
std::string BadInputOf(Call call) {
  try {
    call();
  } catch (const BadInput& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "nothing was thrown";
}

// The message of the BadInput that `call` throws, of as many lines as there are problems; "" when
// it throws none.
template <class Call>
std::string ProblemsOf(Call call) {
  try {
    call();
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

// `text` with every `from` replaced by `to`.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_SCRATCH_H_
