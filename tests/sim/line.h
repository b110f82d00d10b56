#ifndef FACEWIRE_TESTS_SIM_LINE_H_
#define FACEWIRE_TESTS_SIM_LINE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tests/sim/faults.h"
#include "tests/sim/random.h"

namespace facewire::sim {

// Nanoseconds since the origin of Time: a byte at 3 Mbaud takes 3.33 us.
using Nanos = std::int64_t;

// The wire between a host and its servos: bytes take the time that the baud rate says (8N1, ten
// bits each), and on a half-duplex wire whoever talks at the same time damages both. Line faults
// happen here.
class Line {
 public:
  struct Byte {
    Nanos start, end;
    std::uint8_t value;
  };

  // With `echo` the host's adapter gives it its own bytes back, too.
  Line(double baud, bool half_duplex, bool echo, const LineFaults& faults, std::uint64_t seed)
      : baud_(baud), half_duplex_(half_duplex), echo_(echo), faults_(faults), random_(seed) {}

  LineFaults& faults() { return faults_; }
  double baud() const { return baud_; }
  void SetBaud(double baud) { baud_ = baud; }  // of bytes from now on
  Nanos byte_ns() const { return static_cast<Nanos>(10e9 / baud_); }

  // The host's bytes; the first starts at `now`, or when the ones before are out.
  void FromHost(std::span<const std::byte> bytes, Nanos now);
  // A reply that starts at `start` (later by chance, when replies are late). Returns its end.
  Nanos FromServo(std::span<const std::uint8_t> bytes, Nanos start);
  // Bytes that nobody sent in the last `passed`, on a wire that is quiet at `now`.
  void Noise(Nanos now, Nanos passed);

  // The next byte that is at the servos by `now`; kNever as long as there is none on the way.
  static constexpr Nanos kNever = INT64_MAX;
  Nanos NextAtServos() const { return to_servos_.empty() ? kNever : to_servos_.front().end; }
  Byte TakeAtServos();
  // When the next byte is at the host; and all that are there by `now`.
  Nanos NextAtHost() const { return to_host_.empty() ? kNever : to_host_.front().end; }
  void TakeAtHost(Nanos now, std::vector<std::byte>& bytes);

  // How many times two talked at once since the last call.
  int TakeCollisions();

 private:
  void Put(std::deque<Byte>& queue, Byte byte);
  void Collide(std::deque<Byte>& others, Byte& byte);

  double baud_;
  bool half_duplex_;
  bool echo_;
  LineFaults faults_;
  Random random_;
  std::deque<Byte> to_servos_, to_host_;
  Nanos host_free_ = 0;
  bool colliding_ = false;
  int collisions_ = 0;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_LINE_H_
