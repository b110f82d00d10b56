#ifndef FACEWIRE_APP_REPORT_H_
#define FACEWIRE_APP_REPORT_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/time.h"

namespace facewire::app {

// What a service holds, part by part.
struct MemoryReport {
  struct Part {
    std::string name;
    std::size_t bytes = 0;
    std::string what;
  };
  std::vector<Part> parts;
};
// As a table with a total.
std::string Table(const MemoryReport& report);

// What a run came to.
struct RunReport {
  double seconds = 0;
  std::uint64_t ticks = 0;
  std::uint64_t frames = 0;
  double fps = 0;
  std::uint64_t frames_dropped = 0;
  std::uint64_t frames_damaged = 0;  // of those, broken ones
  std::uint64_t faces = 0;
  std::uint64_t rejected = 0;
  std::uint64_t losses = 0;
  std::uint64_t blinks = 0;
  std::int64_t latency_p50_us = 0;  // from capture (a fast replay: from acquisition) to the line
  std::int64_t latency_p99_us = 0;
  std::uint64_t camera_restarts = 0;
  std::uint64_t poses_sent = 0;
  std::uint64_t poses_dropped = 0;
  std::uint64_t line_errors = 0;
  std::uint64_t line_bytes = 0;
  std::uint64_t line_losses = 0;   // times that the open line was lost
  std::uint64_t line_reopens = 0;  // times that it was opened again
  std::size_t resident_bytes = 0;  // of the whole process, now
  std::size_t footage_bytes = 0;   // of that, the recording decoded ahead
};
// One line for a person.
std::string Summary(const RunReport& report);
// A JSON object with the members by their names. Throws Failure when it cannot be written; nothing
// half-written is left.
void WriteJson(const std::filesystem::path& file, const RunReport& report);

// Of this process; 0 when the system does not tell. Allocate nothing.
std::size_t ResidentBytes() noexcept;
std::size_t ThreadCount() noexcept;
// Since the process was started, which is before its first instruction: the loader's time counts.
Duration ProcessAge() noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_REPORT_H_
