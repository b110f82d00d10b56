#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_MOVER_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_MOVER_H_

#include <optional>
#include <string>

#include "app/animatronic/servo_output.h"
#include "hal/clock.h"
#include "tools/facewire/servo/installation.h"

namespace facewire::tools {

// One servo moved by hand, through everything that moves servos in the service: limits, speeds,
// crawl, rules and heat hold. A program that dies lets go.
class Mover {
 public:
  // Takes what PartOf or Alone gives. Throws BadInput as ServoOutput; `clock` is borrowed.
  Mover(const Installation& part, std::size_t servo, hal::Clock& clock);
  // Throws BadInput, Failure. Then looks until the servo is found, which takes `longest` at most;
  // throws Failure, one line with the reason, when it does not answer or is refused.
  void Open(Duration longest);
  // Everything limp, ports closed.
  ~Mover();
  Mover(const Mover&) = delete;
  Mover& operator=(const Mover&) = delete;

  void GoTo(float position);
  void LetGo();  // at once; GoTo ends it
  // One tick, then waits for the time of the next one.
  void Tick();

  const servo::Servo& servo() const { return part_.servos.servos[servo_]; }
  const app::ServoBusConfig& bus() const;
  bool reads_back() const;
  const bus::ServoFeedback& said() const { return output_.animatronic().feedback(servo_); }
  const servo::Command& command() const { return output_.animatronic().commands().servos[servo_]; }
  // Where it is, as well as that is known: read, else as told.
  float position() const;
  std::optional<float> goal() const { return goal_; }
  // Whether it has been told all of the way to its goal; one that is let go has.
  bool arrived() const;
  // Why it does not do as it is told; "" when it does.
  std::string trouble() const;

 private:
  Installation part_;
  std::size_t servo_;
  hal::Clock& clock_;
  app::ServoOutput output_;
  Time next_{};
  std::optional<float> goal_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_MOVER_H_
