#include "tools/facewire/servo/jog.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/full_screen.h"

namespace facewire::tools {
namespace {

// Parts of what the servo may do at all. A small step can just be seen.
constexpr float kSmall = 1.0F / 200;
constexpr float kLarge = 1.0F / 20;
constexpr int kBarWidth = 60;
constexpr std::chrono::milliseconds kDrawEvery(50);
// What one word of a script may take: the slowest way from end to end takes a third of it.
constexpr std::chrono::seconds kLongestWord(60);

std::string Text(const char* format, double value) {
  std::array<char, 48> text;
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

float WholeStep(float step) { return std::max(1.0F, std::round(step)); }

}  // namespace

Jog::Jog(Mover& mover, JogOptions options)
    : mover_(mover),
      options_(std::move(options)),
      small_(WholeStep((mover.servo().max - mover.servo().min) * kSmall)),
      large_(WholeStep((mover.servo().max - mover.servo().min) * kLarge)) {}

void Jog::Move(float by) {
  const servo::Servo& servo = mover_.servo();
  // From where it was told to go, so that keys add up; from where it is, when it was limp.
  const float from = mover_.goal().value_or(mover_.position());
  const float to = std::clamp(std::round(from + by), servo.min, servo.max);
  if (to == from) note_ = "this is the end of its range";
  mover_.GoTo(to);
}

void Jog::Mark(std::optional<float>& mark) {
  // Where it is told to be, which is what it will be told again; limp it can be moved by hand.
  mark = mover_.goal() && mover_.command().torque ? mover_.command().position : mover_.position();
}

void Jog::Confirm() {
  if (!options_.marks) return;
  if (!marks_.first || !marks_.second || !marks_.neutral) {
    note_ = "mark both ends (1, 2) and the neutral position (3) first";
    return;
  }
  const auto [low, high] = std::minmax(*marks_.first, *marks_.second);
  if (high - low < 2 * small_) {
    note_ = "the ends are the same place; go to each and mark it";
  } else if (*marks_.neutral < low || *marks_.neutral > high) {
    note_ = "the neutral position is not between the ends";
  } else {
    confirmed_ = over_ = true;
  }
}

void Jog::Press(const Key& key) {
  note_.clear();
  switch (key.kind) {
    case Key::Kind::kLeft:
      return Move(-small_);
    case Key::Kind::kRight:
      return Move(small_);
    case Key::Kind::kDown:
      return Move(-large_);
    case Key::Kind::kUp:
      return Move(large_);
    case Key::Kind::kPosition:
      return mover_.GoTo(std::clamp(key.position, mover_.servo().min, mover_.servo().max));
    case Key::Kind::kEnter:
      return Confirm();
    case Key::Kind::kQuit:
      over_ = true;
      return;
    case Key::Kind::kOther:
      break;
  }
  if (key.character == 'n') mover_.GoTo(mover_.servo().neutral);
  if (key.character == ' ') mover_.LetGo();
  if (!options_.marks) return;
  if (key.character == '1') Mark(marks_.first);
  if (key.character == '2') Mark(marks_.second);
  if (key.character == '3') Mark(marks_.neutral);
}

std::string Jog::Draw() const {
  const servo::Servo& servo = mover_.servo();
  const bus::ServoFeedback& said = mover_.said();
  const std::string unit = UnitOf(mover_.bus());
  std::string bar(kBarWidth, '-');
  const auto put = [&](std::optional<float> at, char c) {
    if (!at) return;
    const float part = (*at - servo.min) / (servo.max - servo.min);
    bar[static_cast<std::size_t>(std::clamp(part, 0.0F, 1.0F) * (kBarWidth - 1))] = c;
  };
  put(servo.neutral, '.');
  put(marks_.first, '1');
  put(marks_.second, '2');
  put(marks_.neutral, '3');
  put(mover_.position(), '#');
  std::string out = options_.title + "\n\n  " + Text("%g", servo.min) + " " + bar + " " +
                    Text("%g", servo.max) + " " + unit + "\n\n";
  out += "  told   " + (mover_.command().torque ? Text("%.6g ", mover_.command().position) + unit
                                                : std::string("limp"));
  if (mover_.goal() && !mover_.arrived()) out += "  on its way to " + Text("%.6g", *mover_.goal());
  if (mover_.reads_back()) {
    out +=
        "\n  is at  " + (said.position ? Text("%.6g ", *said.position) + unit : std::string("-"));
  } else {
    out += "\n  is at  ? (nobody can tell; the servo goes where its pulses say)";
  }
  if (said.temperature_c) out += Text("   %.0f C", *said.temperature_c);
  if (said.load) out += Text("   load %.0f %%", *said.load * 100);
  if (said.voltage_v) out += Text("   %.1f V", *said.voltage_v);
  out += "\n";
  if (options_.marks) {
    const auto shown = [](std::optional<float> mark) {
      return mark ? Text("%.6g", *mark) : std::string("-");
    };
    out += "  marked 1: " + shown(marks_.first) + "   2: " + shown(marks_.second) +
           "   3 (neutral): " + shown(marks_.neutral) + "\n";
  }
  out += "  " + mover_.trouble() + (mover_.trouble().empty() ? "" : "  ") + note_ + "\n\n";
  out += "  left/right " + Text("%.6g", small_) + ", down/up " + Text("%.6g", large_) +
         ", n neutral, space limp";
  out += options_.marks ? ", 1 2 3 mark, Enter done, q give up\n" : ", q quit\n";
  if (options_.marks && mover_.reads_back()) {
    out += "  While it is limp you can move it by hand and mark where it is.\n";
  }
  return out;
}

void RunJog(Jog& jog, Mover& mover, const std::function<bool()>& stop) {
  KeyInput keys;
  std::optional<FullScreen> screen;
  if (keys.terminal() && ::isatty(STDOUT_FILENO) == 1) screen.emplace();
  hal::SystemClock clock;
  Time next_draw{};
  Time next_word = clock.Now() + kLongestWord;
  while (!jog.over() && !stop()) {
    if (const auto key = keys.Next(mover.arrived())) {
      jog.Press(*key);
      next_word = clock.Now() + kLongestWord;
    } else if (!keys.terminal() && clock.Now() > next_word) {
      throw app::Failure("the servo does not get where it is told to go: " + mover.trouble());
    }
    mover.Tick();
    if (!screen || clock.Now() < next_draw) continue;
    next_draw = clock.Now() + kDrawEvery;
    std::string out = "\x1b[H";
    for (const char c : jog.Draw()) out += c == '\n' ? "\x1b[K\r\n" : std::string(1, c);
    WriteOut(out + "\x1b[J");
  }
}

}  // namespace facewire::tools
