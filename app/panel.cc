#include "app/panel.h"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include "app/status_light.h"

namespace facewire::app {
namespace {

constexpr Duration kBetweenWords = std::chrono::seconds(1);

constexpr const char* kClosed = "closed; a release ends the stop";
constexpr const char* kOpen = "open";
constexpr const char* kUnreadableStop = "cannot be read, which counts as open";
constexpr const char* kReadable = "can be read";
constexpr const char* kUnreadable = "cannot be read";
constexpr const char* kSet = "can be set";
constexpr const char* kOn = "on";
constexpr const char* kOff = "off";
constexpr const char* kUnset = "cannot be set";

}  // namespace

// Uses the line; one that was lost is taken again when it is time, and used then.
template <class Line, class Call>
auto Panel::Use(Watched<Line>& watched, Time now, Call call) noexcept {
  auto result = call(*watched.line);
  if (!result && result.error() == Errc::kDisconnected && watched.reopen.Due(now)) {
    if (watched.line->Open()) result = call(*watched.line);
    if (!result) watched.reopen.Failed(now);
  }
  if (result) watched.reopen.Succeeded();
  return result;
}

template <class Line>
void Panel::Tell(Watched<Line>& watched, Time now, const char* text) noexcept {
  if (watched.told == text || now < watched.next_word) return;
  watched.told = text;
  watched.next_word = now + kBetweenWords;
  if (!log_) return;
  const std::string_view why = watched.line->reason();
  std::array<char, 256> words;
  (void)std::snprintf(words.data(), words.size(), "%s: %s%s%.*s", watched.name, text,
                      why.empty() ? "" : ": ", static_cast<int>(why.size()), why.data());
  log_(words.data());
}

// What is told first is a change from these.
Panel::Panel(const PanelLines& lines, std::function<void(const char*)> log)
    : stop_{lines.stop, "emergency stop", kClosed},
      calibrate_{lines.calibrate, "button", kReadable},
      status_led_{lines.status_led, "status LED", kSet},
      servo_power_{lines.servo_power, "servo power", kOff},
      log_(std::move(log)) {}

bool Panel::ReadStop(Time now) noexcept {
  if (stop_.line == nullptr) return false;
  const Result<bool> open = Use(stop_, now, [](auto& line) { return line.Get(); });
  stop_open_ = !open || *open;
  Tell(stop_, now, !open ? kUnreadableStop : stop_open_ ? kOpen : kClosed);
  return stop_open_;
}

Button::Press Panel::ReadButton(Time now) noexcept {
  if (calibrate_.line == nullptr) return Button::Press::kNone;
  const Result<bool> down = Use(calibrate_, now, [](auto& line) { return line.Get(); });
  Tell(calibrate_, now, down ? kReadable : kUnreadable);
  if (down) return button_.Update(*down, now);
  button_.Forget();
  return Button::Press::kNone;
}

void Panel::Show(const PanelView& view) noexcept {
  const bool light = LightOf(view);
  const bool power = powered_ = PowerOf(view);
  Set(status_led_, light, view.now, kSet);
  Set(servo_power_, power, view.now, power ? kOn : kOff);
}

// A new pattern begins with its first flash.
bool Panel::LightOf(const PanelView& view) noexcept {
  if (!shown_since_ || shown_ != view.state || shown_calibrating_ != view.calibrating) {
    shown_ = view.state;
    shown_calibrating_ = view.calibrating;
    shown_since_ = view.now;
  }
  return !view.ending && StatusLight(view.state, view.calibrating, view.now - *shown_since_);
}

// Whoever has power can move: so only while what moves them is known to be in order.
bool Panel::PowerOf(const PanelView& view) noexcept {
  if (view.state == ServiceState::kFault) {
    heard_.reset();
  } else if (view.pose_taken) {
    heard_ = view.now;
  }
  return heard_ && view.now - *heard_ < kUnheard && view.servos_well && view.torque && !view.ending;
}

void Panel::Set(Watched<hal::GpioOutput>& output, bool asserted, Time now,
                const char* text) noexcept {
  if (output.line == nullptr) return;
  const Result<> set = Use(output, now, [asserted](auto& line) { return line.Set(asserted); });
  Tell(output, now, set ? text : kUnset);
}

}  // namespace facewire::app
