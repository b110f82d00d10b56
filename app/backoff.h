#ifndef FACEWIRE_APP_BACKOFF_H_
#define FACEWIRE_APP_BACKOFF_H_

#include <algorithm>
#include <chrono>

#include "core/base/time.h"

namespace facewire::app {

// When to try again what has failed: soon at first, then ever more rarely. A device that was
// replugged is back within a second; one that is gone must not cost the loop its time.
class Backoff {
 public:
  static constexpr Duration kFirst = std::chrono::milliseconds(250);
  static constexpr Duration kLongest = std::chrono::seconds(8);

  bool Due(Time now) const noexcept { return now >= next_; }
  void Failed(Time now) noexcept {
    next_ = now + wait_;
    wait_ = std::min(2 * wait_, kLongest);
  }
  void Succeeded() noexcept {
    next_ = {};
    wait_ = kFirst;
  }

 private:
  Time next_{};
  Duration wait_ = kFirst;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_BACKOFF_H_
