#ifndef FACEWIRE_TESTS_APP_SCRATCH_H_
#define FACEWIRE_TESTS_APP_SCRATCH_H_

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "app/error.h"

namespace facewire::app {

// A folder of its own for one test, gone afterwards.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "facewire-XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

 private:
  std::filesystem::path folder_;
};

// The message of the BadInput that `call` throws; "" when it throws none.
template <class Call>
std::string BadInputOf(Call call) {
  try {
    call();
  } catch (const BadInput& e) {
    return e.what();
  }
  return "";
}

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_SCRATCH_H_
