#include "tools/facewire/servo/line.h"

#include <array>
#include <chrono>
#include <string>

#include "app/error.h"

namespace facewire::tools {
namespace {

using std::chrono::milliseconds;

// At 9600 baud the longest packet of a search takes a tenth of it.
constexpr milliseconds kWriteFor(200);
// A line that never falls silent is not a servo bus.
constexpr Duration kLongestDrain = std::chrono::seconds(1);

}  // namespace

void Line::Send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto taken = port_.Write(bytes, kWriteFor);
    if (!taken) throw app::Failure(std::string("writing to the port: ") + Name(taken.error()));
    bytes = bytes.subspan(*taken);
  }
}

bool Line::Receive(Duration timeout, const std::function<bool(std::span<const std::byte>)>& take) {
  const Time end = clock_.Now() + timeout;
  std::array<std::byte, 1024> buffer;
  for (Time now = clock_.Now(); now < end; now = clock_.Now()) {
    const auto got = port_.Read(buffer, std::chrono::ceil<milliseconds>(end - now));
    if (got && take(std::span(buffer).first(*got))) return true;
    if (!got && got.error() != Errc::kTimeout) {
      throw app::Failure(std::string("reading from the port: ") + Name(got.error()));
    }
  }
  return false;
}

void Line::Drain(Duration quiet) {
  const Time end = clock_.Now() + kLongestDrain;
  while (clock_.Now() < end && Receive(quiet, [](auto) { return true; })) {
  }
}

}  // namespace facewire::tools
