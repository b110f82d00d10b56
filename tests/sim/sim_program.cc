#include "tests/sim/sim_program.h"

#include <fcntl.h>
#include <termios.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <span>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "hal/posix/unique_fd.h"
#include "hal/pty/pty_host.h"
#include "hal/system_clock.h"

namespace facewire::sim {
namespace {

using std::chrono::milliseconds;

volatile std::sig_atomic_t stopped = 0;
void Stop(int) { stopped = 1; }

// Writes what the bus does to a file while it happens: changes only, or an hour would be gigabytes.
class TraceFile {
 public:
  // False when the file cannot be written.
  bool Open(const std::string& path, Trace& trace) {
    file_.open(path, std::ios::trunc);
    file_ << CsvHeader();
    trace.OnSample([this](const Sample& sample) {
      if (is_change_(sample)) file_ << CsvLine(sample);
    });
    trace.OnEvent([this](const Event& event) { file_ << CsvLine(event); });
    return Flush();
  }
  bool Flush() { return static_cast<bool>(file_.flush()); }

 private:
  std::ofstream file_;
  ChangeFilter is_change_;
};

// The baud rate that whoever has the device open has set on it; 0: one that is not in the list.
double RateOf(const std::string& device) {
  constexpr std::array<std::pair<speed_t, double>, 12> kRates = {{{B9600, 9600},
                                                                  {B38400, 38400},
                                                                  {B57600, 57600},
                                                                  {B115200, 115200},
                                                                  {B230400, 230400},
                                                                  {B460800, 460800},
                                                                  {B500000, 500000},
                                                                  {B921600, 921600},
                                                                  {B1000000, 1e6},
                                                                  {B2000000, 2e6},
                                                                  {B3000000, 3e6},
                                                                  {B4000000, 4e6}}};
  const hal::posix::UniqueFd fd(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  termios settings{};
  if (::tcgetattr(fd.get(), &settings) != 0) return 0;
  for (const auto& [code, rate] : kRates) {
    if (code == ::cfgetospeed(&settings)) return rate;
  }
  return 0;
}

}  // namespace

int RunOnPty(const std::string& program, SimBusOptions& options) {
  const auto fail = [&](const std::string& what, int code = 1) {
    std::fprintf(stderr, "%s: %s\n", program.c_str(), what.c_str());
    return code;
  };
  std::signal(SIGINT, Stop);
  std::signal(SIGTERM, Stop);
  hal::SystemClock clock;
  const Time start = clock.Now();
  options.bus->Advance(start);
  hal::pty::PtyHost line(options.link);
  if (const Result<> open = line.Open(); !open) {
    return fail("--link: cannot make " + options.link, 2);
  }
  TraceFile trace_file;
  const bool traced = !options.trace.empty();
  if (traced && !trace_file.Open(options.trace, options.bus->trace())) {
    return fail("--trace: cannot write " + options.trace, 2);
  }
  std::printf("%s: %s on %s\n", program.c_str(), options.about.c_str(), options.link.c_str());
  std::fflush(stdout);

  Time flushed = start;
  while (stopped == 0) {
    std::array<std::byte, 4096> buffer;
    const Result<std::size_t> got = line.Read(buffer, milliseconds(1));
    const Time now = clock.Now();
    if (got && options.strict_baud) {
      const double rate = RateOf(line.device_path());
      if (rate == 0) continue;  // no servo has that one
      options.bus->SetBaud(rate);
    }
    if (got) {
      options.bus->Receive(std::span(buffer).first(*got), now);
    } else if (got.error() != Errc::kTimeout) {
      return fail("the line is gone");
    }
    options.bus->Advance(now);
    if (const std::vector<std::byte> bytes = options.bus->Transmit(); !bytes.empty()) {
      // Nobody there, or nobody who reads: the bytes are gone, as on a wire.
      (void)line.Write(bytes, milliseconds(0));
    }
    if (traced && now - flushed > milliseconds(100)) {
      flushed = now;
      if (!trace_file.Flush()) return fail("cannot write " + options.trace);
    }
    if (options.runs > Duration{} && now - start >= options.runs) break;
  }
  for (std::size_t kind = 0; kind < kEventKinds; ++kind) {
    const std::size_t count = options.bus->trace().Count(static_cast<EventKind>(kind));
    if (count > 0) std::printf("%s %zu\n", Name(static_cast<EventKind>(kind)), count);
  }
  if (traced && !trace_file.Flush()) return fail("cannot write " + options.trace);
  return 0;
}

}  // namespace facewire::sim
