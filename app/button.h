#ifndef FACEWIRE_APP_BUTTON_H_
#define FACEWIRE_APP_BUTTON_H_

#include <chrono>
#include <cstdint>
#include <optional>

#include "core/base/time.h"

namespace facewire::app {

// A button that a person presses shortly or long. Contacts bounce, and what is read now and then is
// only a sample: a level counts once it was read twice, kSteady or more apart, and never otherwise
// in between.
class Button {
 public:
  static constexpr Duration kSteady = std::chrono::milliseconds(30);
  static constexpr Duration kLong = std::chrono::seconds(2);

  enum class Press : std::uint8_t { kNone, kShort, kLong };

  // The level at `now`. kShort at the end of a short press; kLong while it is still held, so that
  // the hand notices when to let go. A button that is down from the beginning (a stuck one, a
  // shorted line) means nothing until it was up once.
  Press Update(bool down, Time now) noexcept;
  // The line cannot be read: a press that had begun is none.
  void Forget() noexcept { *this = {}; }

 private:
  std::optional<bool> level_;  // as read last
  Time since_{};               // it has been so
  bool armed_ = false;         // was up, so the next press counts
  bool pressed_ = false;       // a press has begun
  Time pressed_at_{};
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_BUTTON_H_
