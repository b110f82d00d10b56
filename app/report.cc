#include "app/report.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iomanip>
#include <span>
#include <sstream>

#include "app/checked_file.h"
#include "hal/posix/unique_fd.h"

namespace facewire::app {
namespace {

std::string Kib(std::size_t bytes) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << static_cast<double>(bytes) / 1024;
  return text.str();
}

bool ReadStart(const char* file, std::span<char> text) noexcept {
  const hal::posix::UniqueFd descriptor(::open(file, O_RDONLY | O_CLOEXEC));
  return descriptor && ::read(descriptor.get(), text.data(), text.size() - 1) > 0;
}

// The n'th field of proc(5)'s /proc/self/stat, from 1 and beyond the second; 0: not known.
std::uint64_t StatField(int n) noexcept {
  std::array<char, 1024> text{};
  if (!ReadStart("/proc/self/stat", text)) return 0;
  // The second field, the program's name, may hold anything but ends at the last bracket.
  const char* at = std::strrchr(text.data(), ')');
  for (int field = 2; at != nullptr && field < n; ++field) at = std::strchr(at + 1, ' ');
  return at == nullptr ? 0 : std::strtoull(at + 1, nullptr, 10);
}

}  // namespace

std::string Table(const MemoryReport& report) {
  std::ostringstream text;
  std::size_t total = 0;
  for (const MemoryReport::Part& part : report.parts) {
    text << std::left << std::setw(22) << part.name << std::right << std::setw(12)
         << Kib(part.bytes) << " KiB  " << part.what << '\n';
    total += part.bytes;
  }
  text << std::left << std::setw(22) << "total" << std::right << std::setw(12) << Kib(total)
       << " KiB\n";
  return text.str();
}

std::string Summary(const RunReport& r) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << r.frames << " frames in " << r.seconds << " s ("
       << r.fps << " fps), latency p50 " << static_cast<double>(r.latency_p50_us) / 1000
       << " ms p99 " << static_cast<double>(r.latency_p99_us) / 1000 << " ms, " << r.frames_dropped
       << " dropped, ";
  if (r.frames_damaged > 0) text << r.frames_damaged << " damaged, ";
  text << r.losses << " losses, " << r.blinks << " blinks, " << r.poses_sent << " poses sent, "
       << r.poses_dropped << " not taken by the line, which was lost " << r.line_losses
       << " times and reopened " << r.line_reopens << " times";
  return text.str();
}

void WriteJson(const std::filesystem::path& file, const RunReport& r) {
  std::ostringstream text;
  text << std::setprecision(10) << "{\n  \"seconds\": " << r.seconds
       << ",\n  \"ticks\": " << r.ticks << ",\n  \"frames\": " << r.frames
       << ",\n  \"fps\": " << r.fps << ",\n  \"frames_dropped\": " << r.frames_dropped
       << ",\n  \"frames_damaged\": " << r.frames_damaged << ",\n  \"faces\": " << r.faces
       << ",\n  \"rejected\": " << r.rejected << ",\n  \"losses\": " << r.losses
       << ",\n  \"blinks\": " << r.blinks << ",\n  \"latency_p50_us\": " << r.latency_p50_us
       << ",\n  \"latency_p99_us\": " << r.latency_p99_us
       << ",\n  \"camera_restarts\": " << r.camera_restarts
       << ",\n  \"poses_sent\": " << r.poses_sent << ",\n  \"poses_dropped\": " << r.poses_dropped
       << ",\n  \"line_errors\": " << r.line_errors << ",\n  \"line_bytes\": " << r.line_bytes
       << ",\n  \"line_losses\": " << r.line_losses << ",\n  \"line_reopens\": " << r.line_reopens
       << ",\n  \"resident_bytes\": " << r.resident_bytes
       << ",\n  \"footage_bytes\": " << r.footage_bytes << "\n}\n";
  const std::string json = text.str();
  WriteFileAtomically(file, std::as_bytes(std::span(json)));
}

std::size_t ResidentBytes() noexcept {
  std::array<char, 256> text{};
  unsigned long long pages = 0;
  unsigned long long resident = 0;
  if (!ReadStart("/proc/self/statm", text) ||
      std::sscanf(text.data(), "%llu %llu", &pages, &resident) != 2) {
    return 0;
  }
  return static_cast<std::size_t>(resident) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::size_t ThreadCount() noexcept { return static_cast<std::size_t>(StatField(20)); }

Duration ProcessAge() noexcept {
  timespec now{};
  const std::uint64_t ticks = StatField(22);  // from boot, asleep or not
  if (ticks == 0 || ::clock_gettime(CLOCK_BOOTTIME, &now) != 0) return {};
  const auto per_second = static_cast<std::uint64_t>(::sysconf(_SC_CLK_TCK));
  return std::chrono::seconds(now.tv_sec) +
         std::chrono::duration_cast<Duration>(std::chrono::nanoseconds(now.tv_nsec)) -
         Duration(static_cast<std::int64_t>(ticks * 1'000'000 / per_second));
}

}  // namespace facewire::app
