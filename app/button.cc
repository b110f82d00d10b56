#include "app/button.h"

namespace facewire::app {

Button::Press Button::Update(bool down, Time now) noexcept {
  if (level_ != down) {
    level_ = down;
    since_ = now;
    return Press::kNone;
  }
  if (now - since_ < kSteady) return Press::kNone;
  if (!down) {
    const bool short_press = pressed_;
    pressed_ = false;
    armed_ = true;
    return short_press ? Press::kShort : Press::kNone;
  }
  if (armed_) {
    armed_ = false;
    pressed_ = true;
    pressed_at_ = since_;
  }
  if (!pressed_ || now - pressed_at_ < kLong) return Press::kNone;
  pressed_ = false;
  return Press::kLong;
}

}  // namespace facewire::app
