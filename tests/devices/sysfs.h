#ifndef FACEWIRE_TESTS_DEVICES_SYSFS_H_
#define FACEWIRE_TESTS_DEVICES_SYSFS_H_

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

// Asking the kernel for things through its files. Exceptions fail the test.
namespace facewire::devices {

// Writes `text` in one call, as the kernel's files want it.
inline void Tell(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text << std::flush;
  if (!out) throw std::runtime_error("the kernel refuses '" + text + "' in " + file.string());
}

// Waits for what the kernel or a program does in its own time; an emulated processor may be slow.
inline void WaitUntil(const std::string& what, const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error("waited for: " + what);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace facewire::devices

#endif  // FACEWIRE_TESTS_DEVICES_SYSFS_H_
