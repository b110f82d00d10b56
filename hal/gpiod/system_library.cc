#include "hal/gpiod/system_library.h"

#include <algorithm>
#include <filesystem>

namespace facewire::hal::gpiod {

// Links are left out: newer Raspberry Pi systems keep old numbers alive as links, and a chip must
// not be found twice.
std::vector<std::string> LinkedLibrary::Chips() {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    if (entry.path().filename().string().starts_with("gpiochip") &&
        entry.is_character_file(ignored) && !entry.is_symlink(ignored)) {
      paths.push_back(entry.path().string());
    }
  }
  // gpiochip10 comes after gpiochip9.
  std::ranges::sort(paths, [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return paths;
}

Library& SystemLibrary() noexcept {
  static LinkedLibrary library;
  return library;
}

}  // namespace facewire::hal::gpiod
