#include "app/report.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "app/checked_file.h"

namespace facewire::app {
namespace {

std::string Kib(std::size_t bytes) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << static_cast<double>(bytes) / 1024;
  return text.str();
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

std::size_t ResidentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0;
  std::size_t resident = 0;
  if (!(statm >> pages >> resident)) return 0;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace facewire::app
