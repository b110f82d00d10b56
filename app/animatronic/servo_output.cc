#include "app/animatronic/servo_output.h"

#include <algorithm>
#include <string>

#include "app/devices.h"
#include "app/error.h"

namespace facewire::app {
namespace {

constexpr std::chrono::milliseconds kAtOnce(0);
// As much as a tick reads of one port: a line that babbles must not keep the others waiting.
constexpr std::size_t kMostRead = 4096;

}  // namespace

const char* Name(PortState state) noexcept {
  switch (state) {
    case PortState::kClosed:
      return "gone";
    case PortState::kUp:
      return "up";
    case PortState::kStuck:
      return "takes nothing";
  }
  return "unknown";
}

ServoOutput::ServoOutput(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig,
                         hal::Clock& clock)
    : ServoOutput(buses, rig, clock,
                  [](const ServoBusConfig& bus) { return MakeHostLine(bus.port, bus.baud); }) {}

ServoOutput::ServoOutput(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig,
                         hal::Clock& clock, const MakePort& make_port)
    : clock_(clock), drivers_(buses, rig) {
  const Result<> ok = animatronic_.Configure(rig, drivers_.attachments());
  if (!ok) throw BadInput(std::string("the rig's servos: ") + facewire::Name(ok.error()));
  lines_.reserve(buses.size());  // spans point into them
  for (const ServoBusConfig& bus : buses) {
    Line& line = lines_.emplace_back();
    line.port = make_port(bus);
    line.address = bus.port;
    line.baud = bus.baud;
  }
}

void ServoOutput::Open() {
  std::string problems;
  for (Line& line : lines_) {
    Collect(problems, [&] {
      OpenSerialPort(*line.port, line.address, line.baud);
      line.open = true;
      line.taken = clock_.Now();
    });
  }
  if (!problems.empty()) throw BadInput(problems);
}

void ServoOutput::Tick() noexcept {
  const Time now = clock_.Now();
  for (std::size_t bus = 0; bus < lines_.size(); ++bus) {
    if (!lines_[bus].open) Reopen(bus, now);
    Read(bus, now);
  }
  animatronic_.Update(now);
  for (std::size_t bus = 0; bus < lines_.size(); ++bus) Write(bus, now);
}

void ServoOutput::Close(Duration longest) noexcept {
  animatronic_.LetGo();
  Time next = clock_.Now();
  const Time end = next + longest;
  do {
    Tick();
    next += period();
    clock_.SleepUntil(next);
  } while (next < end && !AllSaid());
  for (Line& line : lines_) {
    line.port->Close();
    line.open = false;
  }
}

bool ServoOutput::AllSaid() const noexcept {
  return animatronic_.Limp() &&
         std::ranges::all_of(lines_, [](const Line& line) { return line.unsent.empty(); });
}

PortState ServoOutput::port(std::size_t bus) const noexcept {
  const Line& line = lines_[bus];
  if (!line.open) return PortState::kClosed;
  return line.stuck ? PortState::kStuck : PortState::kUp;
}

void ServoOutput::Reopen(std::size_t bus, Time now) noexcept {
  Line& line = lines_[bus];
  if (!line.reopen.Due(now)) return;
  if (!line.port->Open()) {
    line.reopen.Failed(now);
    return;
  }
  line.reopen.Succeeded();
  line.open = true;
  line.taken = now;
  ++line.counters.reopens;
  animatronic_.Restart(bus);
}

// Its servos count as absent at once, so that nobody takes old words of theirs for new.
void ServoOutput::Lose(std::size_t bus, Time now) noexcept {
  Line& line = lines_[bus];
  line.port->Close();
  line.open = line.stuck = false;
  line.unsent = {};
  line.reopen.Failed(now);
  ++line.counters.losses;
  animatronic_.Restart(bus);
}

void ServoOutput::Read(std::size_t bus, Time now) noexcept {
  Line& line = lines_[bus];
  std::array<std::byte, 512> bytes;
  for (std::size_t all = 0; line.open && all < kMostRead;) {
    const Result<std::size_t> read = line.port->Read(bytes, kAtOnce);
    if (!read) {
      if (read.error() != Errc::kTimeout) Lose(bus, now);
      return;
    }
    all += *read;
    line.counters.bytes_in += *read;
    animatronic_.Receive(bus, std::span(bytes).first(*read), now);
  }
}

void ServoOutput::Write(std::size_t bus, Time now) noexcept {
  Line& line = lines_[bus];
  if (!line.open) return;
  line.unsent = line.unsent.subspan(Push(bus, line.unsent, now));
  if (!line.unsent.empty() || !line.open) return;
  const std::span<const std::byte> bytes = animatronic_.Bytes(bus, now);
  const std::span<const std::byte> left = bytes.subspan(Push(bus, bytes, now));
  if (!line.open) return;
  std::ranges::copy(left, line.rest.begin());
  line.unsent = std::span(line.rest).first(left.size());
}

std::size_t ServoOutput::Push(std::size_t bus, std::span<const std::byte> bytes,
                              Time now) noexcept {
  Line& line = lines_[bus];
  std::size_t taken = 0;
  if (!bytes.empty()) {
    const Result<std::size_t> wrote = line.port->Write(bytes, kAtOnce);
    if (wrote) {
      taken = *wrote;
    } else if (wrote.error() != Errc::kTimeout) {
      Lose(bus, now);
      return 0;
    }
  }
  line.counters.bytes_out += taken;
  if (bytes.empty() || taken > 0) {
    line.taken = now;
    line.stuck = false;
  } else if (!line.stuck && now - line.taken >= kStuckAfter) {
    line.stuck = true;
    ++line.counters.stuck;
  }
  return taken;
}

}  // namespace facewire::app
