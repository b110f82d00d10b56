#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_KEYS_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_KEYS_H_

#include <termios.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// What a person presses, or a script says, while a servo is being moved.
namespace facewire::tools {

struct Key {
  enum class Kind : std::uint8_t { kLeft, kRight, kUp, kDown, kEnter, kQuit, kPosition, kOther };
  Kind kind = Kind::kOther;
  char character = 0;  // of kOther
  float position = 0;  // of kPosition: go there
  friend bool operator==(const Key&, const Key&) = default;
};

// Bytes of a terminal to keys; an arrow may come in pieces.
class KeyDecoder {
 public:
  void Add(std::string_view bytes) { pending_ += bytes; }
  // `complete`: nothing more is on its way, so an Escape is one.
  std::optional<Key> Next(bool complete);

 private:
  std::string pending_;
};

// A word of a script: "left", "right", "up", "down", "enter", "quit", "space", a single character
// as it would be pressed, or "=1500" for a position. nullopt: none of these.
std::optional<Key> KeyOfWord(std::string_view word);

// The standard input, without waiting: keys of a terminal, which is raw while this lives, or words
// of anything else. A word is only given when the one before it has been done.
class KeyInput {
 public:
  KeyInput();
  ~KeyInput();
  KeyInput(const KeyInput&) = delete;
  KeyInput& operator=(const KeyInput&) = delete;

  bool terminal() const { return terminal_; }
  // `done`: what the last key asked for has been reached. The end of a script is kQuit. Throws
  // BadInput for a word that is no key.
  std::optional<Key> Next(bool done);

 private:
  std::optional<Key> NextWord();

  bool terminal_;
  termios before_{};
  KeyDecoder decoder_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_KEYS_H_
