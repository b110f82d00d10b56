#ifndef FACEWIRE_APP_PANEL_H_
#define FACEWIRE_APP_PANEL_H_

#include <chrono>
#include <functional>
#include <optional>

#include "app/backoff.h"
#include "app/button.h"
#include "core/base/time.h"
#include "core/service_state.h"
#include "hal/gpio.h"

namespace facewire::app {

// The lines of a board that the service may have; null: none. All are borrowed, and open.
struct PanelLines {
  hal::GpioInput* stop = nullptr;       // asserted: the emergency stop's contact is open
  hal::GpioInput* calibrate = nullptr;  // asserted: the button is down
  hal::GpioOutput* status_led = nullptr;
  hal::GpioOutput* servo_power = nullptr;  // asserted: the servos have power
};

// What a tick came to, as far as the panel shows it.
struct PanelView {
  Time now{};
  ServiceState state = ServiceState::kStarting;
  bool torque = false;       // the state machine's word
  bool pose_taken = false;   // the host's line took this tick's pose; without a line, the buses did
  bool servos_well = true;   // ServoPower's word, where servos hang on buses
  bool calibrating = false;  // somebody asked for it, and it is running
  bool ending = false;       // the last tick, or only a new process can help
};

// Emergency stop, button, status LED and servo power: what there is of them is read and set once a
// tick. A line that was lost is taken again with back-off; taking it may allocate, nothing else
// does.
class Panel {
 public:
  // After so long without a pose that the line took, nobody holds the servos: no power.
  static constexpr Duration kUnheard = std::chrono::seconds(1);

  // `log` hears in words for a person what lines do and why they fail: at most once a second for
  // each line. It may be empty.
  Panel(const PanelLines& lines, std::function<void(const char*)> log);

  // Whether the emergency stop's contact is open at `now`. A line that cannot be read may be a cut
  // one, and counts as open.
  bool ReadStop(Time now) noexcept;
  // As ReadStop said last.
  bool stop_open() const noexcept { return stop_open_; }
  // What the button was last pressed for. One that cannot be read is not pressed: it must not
  // release an emergency stop.
  Button::Press ReadButton(Time now) noexcept;

  // False: the line for the servos' power is off.
  bool servos_powered() const noexcept { return servo_power_.line == nullptr || powered_; }

  // Sets the outputs.
  void Show(const PanelView& view) noexcept;

 private:
  template <class Line>
  struct Watched {
    Line* line;
    const char* name;
    const char* told;  // about it
    Time next_word{};
    Backoff reopen{};
  };

  template <class Line, class Call>
  static auto Use(Watched<Line>& watched, Time now, Call call) noexcept;
  template <class Line>
  void Tell(Watched<Line>& watched, Time now, const char* text) noexcept;
  bool LightOf(const PanelView& view) noexcept;
  bool PowerOf(const PanelView& view) noexcept;
  void Set(Watched<hal::GpioOutput>& output, bool asserted, Time now, const char* text) noexcept;

  Watched<hal::GpioInput> stop_;
  Watched<hal::GpioInput> calibrate_;
  Watched<hal::GpioOutput> status_led_;
  Watched<hal::GpioOutput> servo_power_;
  std::function<void(const char*)> log_;

  bool stop_open_ = false;
  Button button_;
  bool powered_ = false;
  std::optional<Time> heard_;  // when the line last took a pose; none since the last fault
  ServiceState shown_ = ServiceState::kStarting;
  bool shown_calibrating_ = false;
  std::optional<Time> shown_since_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_PANEL_H_
