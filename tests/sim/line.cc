#include "tests/sim/line.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace facewire::sim {

// Keeps `queue` in the order of arrival (replies of several servos may be under way at once).
void Line::Put(std::deque<Byte>& queue, Byte byte) {
  if (random_.Chance(faults_.lose)) return;
  if (random_.Chance(faults_.flip)) {
    byte.value = static_cast<std::uint8_t>(byte.value ^ (1U << (random_.Next() % 8)));
  }
  auto place = queue.end();
  while (place != queue.begin() && std::prev(place)->end > byte.end) --place;
  queue.insert(place, random_.Chance(faults_.duplicate) ? 2 : 1, byte);
}

// Damages `byte` and every one of `others` that is on the wire at the same time.
void Line::Collide(std::deque<Byte>& others, Byte& byte) {
  bool hit = false;
  for (auto other = others.rbegin(); other != others.rend(); ++other) {
    if (byte.start >= other->end) break;  // and so are those before it
    if (other->start >= byte.end) continue;
    other->value = random_.Byte();
    hit = true;
  }
  if (hit) byte.value = random_.Byte();
  if (hit && !colliding_) ++collisions_;
  colliding_ = hit;
}

void Line::FromHost(std::span<const std::byte> bytes, Nanos now) {
  Nanos start = std::max(now, host_free_);
  for (const std::byte b : bytes) {
    Byte byte{start, start + byte_ns(), std::to_integer<std::uint8_t>(b)};
    if (half_duplex_) Collide(to_host_, byte);
    Put(to_servos_, byte);
    if (echo_) Put(to_host_, byte);
    start = byte.end;
  }
  host_free_ = start;
}

Nanos Line::FromServo(std::span<const std::uint8_t> bytes, Nanos start) {
  if (random_.Chance(faults_.late)) {
    start += static_cast<Nanos>(random_.Between(0, faults_.late_ms) * 1e6);
  }
  for (const std::uint8_t value : bytes) {
    Byte byte{start, start + byte_ns(), value};
    if (half_duplex_) {
      Collide(to_servos_, byte);
      Collide(to_host_, byte);
    }
    Put(to_host_, byte);
    start = byte.end;
  }
  return start;
}

void Line::Noise(Nanos now, Nanos passed) {
  const auto busy = [now](const std::deque<Byte>& queue) {
    return !queue.empty() && queue.back().end > now;
  };
  if (busy(to_servos_) || busy(to_host_)) return;
  if (!random_.Chance(faults_.noise_per_s * static_cast<double>(passed) * 1e-9)) return;
  const Byte byte{now, now + byte_ns(), random_.Byte()};
  to_servos_.push_back(byte);
  to_host_.push_back(byte);
}

Line::Byte Line::TakeAtServos() {
  const Byte byte = to_servos_.front();
  to_servos_.pop_front();
  return byte;
}

void Line::TakeAtHost(Nanos now, std::vector<std::byte>& bytes) {
  while (!to_host_.empty() && to_host_.front().end <= now) {
    bytes.push_back(std::byte{to_host_.front().value});
    to_host_.pop_front();
  }
}

int Line::TakeCollisions() { return std::exchange(collisions_, 0); }

}  // namespace facewire::sim
