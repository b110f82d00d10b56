#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_JOG_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_JOG_H_

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "tools/facewire/servo/keys.h"
#include "tools/facewire/servo/mover.h"

namespace facewire::tools {

// What a person has marked while moving a servo; the positions of the moment.
struct Marks {
  std::optional<float> first;
  std::optional<float> second;
  std::optional<float> neutral;
};

struct JogOptions {
  bool marks = false;  // keys 1, 2 and 3 mark; Enter ends with them once all are there
  std::string title;   // first line of the screen
};

// Moves a servo by keys until q, or, with marks, until Enter.
class Jog {
 public:
  // `mover` is borrowed, and open.
  Jog(Mover& mover, JogOptions options);

  void Press(const Key& key);
  bool over() const { return over_; }
  // With marks: ended by Enter, all three there.
  bool confirmed() const { return confirmed_; }
  const Marks& marks() const { return marks_; }
  // The screen: some lines, each ended by a line feed.
  std::string Draw() const;

 private:
  void Move(float by);
  void Mark(std::optional<float>& mark);
  void Confirm();

  Mover& mover_;
  JogOptions options_;
  float small_;
  float large_;
  Marks marks_;
  std::string note_;
  bool over_ = false;
  bool confirmed_ = false;
};

// Runs it with the standard input and the screen. Returns when it is over, or `stop` says so.
void RunJog(Jog& jog, Mover& mover, const std::function<bool()>& stop);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_JOG_H_
