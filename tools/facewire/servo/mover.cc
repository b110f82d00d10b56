#include "tools/facewire/servo/mover.h"

#include <chrono>
#include <cmath>

#include "app/animatronic/servo_words.h"
#include "app/error.h"
#include "tools/facewire/servo/open.h"
#include "tools/facewire/servo/words.h"

namespace facewire::tools {
namespace {

constexpr std::chrono::milliseconds kLongestGoodbye(500);

// The torque of a hand ends with it.
Installation ReadyToLetGo(Installation part) {
  part.servos.contract.stop_torque = {};
  return part;
}

}  // namespace

Mover::Mover(const Installation& part, std::size_t servo, hal::Clock& clock)
    : part_(ReadyToLetGo(part)),
      servo_(servo),
      clock_(clock),
      output_(part_.buses, part_.servos, clock) {}

void Mover::Open(Duration longest) {
  OpenOutput(output_);
  next_ = clock_.Now();
  const Time end = next_ + longest;
  const auto ready = [this] {
    return said().state == bus::ServoState::kLimp && (!reads_back() || said().temperature_c);
  };
  while (clock_.Now() < end && !ready()) Tick();
  if (said().state == bus::ServoState::kLimp) return;
  std::string why = "servo \"" + std::string(servo().name.view()) + "\" ";
  if (said().state == bus::ServoState::kRefused) {
    why += "has settings that make it unsafe to move; `facewire servo list` says which";
    throw app::Failure(why);
  }
  why += "does not answer";
  const std::size_t at = output_.animatronic().bus_of(servo_);
  const std::string of_bus = BusText(output_.animatronic().status(at), bus());
  throw app::Failure(
      why + (of_bus.empty() ? "; is " + std::to_string(servo().id) + " its id?" : ": " + of_bus));
}

Mover::~Mover() { output_.Close(kLongestGoodbye); }

void Mover::GoTo(float position) {
  output_.animatronic().Release();
  goal_ = position;
}

void Mover::LetGo() {
  output_.animatronic().Stop();
  goal_.reset();
}

void Mover::Tick() {
  if (goal_) output_.animatronic().SetManual(servo_, *goal_, clock_.Now());
  output_.Tick();
  next_ += output_.period();
  // After a pause there is nothing to make up.
  if (next_ < clock_.Now()) next_ = clock_.Now();
  clock_.SleepUntil(next_);
}

const app::ServoBusConfig& Mover::bus() const { return FindBus(part_, servo().bus.view()); }

bool Mover::reads_back() const {
  return bus().kind == app::BusKind::kDynamixel || bus().kind == app::BusKind::kFeetech;
}

float Mover::position() const {
  if (reads_back() && said().position) return *said().position;
  return command().position;
}

bool Mover::arrived() const {
  return !goal_ || (command().torque && std::abs(command().position - *goal_) < 1);
}

std::string Mover::trouble() const {
  const bus::ServoFeedback& told = said();
  if (told.state == bus::ServoState::kAbsent) return "does not answer";
  if (told.faults != 0) return app::FaultWords(told.faults).data();
  if (told.factor < 1 && told.reason != bus::Reason::kNone) {
    return std::string(Name(told.reason)) + (told.factor > 0 ? ": slowed down" : ": let go, rests");
  }
  return {};
}

}  // namespace facewire::tools
