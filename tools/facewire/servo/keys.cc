#include "tools/facewire/servo/keys.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <charconv>
#include <utility>

#include "app/error.h"

namespace facewire::tools {
namespace {

constexpr char kEscape = '\x1b';
constexpr char kControlC = '\x03';
constexpr char kControlD = '\x04';

Key::Kind Arrow(char letter) {
  switch (letter) {
    case 'A':
      return Key::Kind::kUp;
    case 'B':
      return Key::Kind::kDown;
    case 'C':
      return Key::Kind::kRight;
    case 'D':
      return Key::Kind::kLeft;
    default:
      return Key::Kind::kOther;
  }
}

Key KeyOf(char c) {
  if (c == '\r' || c == '\n') return {.kind = Key::Kind::kEnter};
  if (c == 'q' || c == kControlC || c == kControlD) return {.kind = Key::Kind::kQuit};
  return {.kind = Key::Kind::kOther, .character = c};
}

bool HasInput() {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  return ::poll(&input, 1, 0) > 0;
}

// One byte; nullopt at the end. Byte by byte, so that what follows is left to other readers.
std::optional<char> ReadByte() {
  char c = 0;
  return ::read(STDIN_FILENO, &c, 1) == 1 ? std::optional(c) : std::nullopt;
}

}  // namespace

std::optional<Key> KeyDecoder::Next(bool complete) {
  if (pending_.empty()) return std::nullopt;
  std::size_t size = 1;
  Key key = KeyOf(pending_[0]);
  if (pending_[0] == kEscape) {
    const bool sequence = pending_.size() < 2 || pending_[1] == '[' || pending_[1] == 'O';
    if (sequence && pending_.size() < 3 && !complete) return std::nullopt;
    if (sequence && pending_.size() >= 3) {
      size = 3;
      key = {.kind = Arrow(pending_[2])};
    }
  }
  pending_.erase(0, size);
  return key;
}

std::optional<Key> KeyOfWord(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, Key>, 7> kWords = {
      {{"left", {Key::Kind::kLeft}},
       {"right", {Key::Kind::kRight}},
       {"up", {Key::Kind::kUp}},
       {"down", {Key::Kind::kDown}},
       {"enter", {Key::Kind::kEnter}},
       {"quit", {Key::Kind::kQuit}},
       {"space", {Key::Kind::kOther, ' '}}}};
  for (const auto& [name, key] : kWords) {
    if (name == word) return key;
  }
  if (word.size() == 1 && word[0] != '=') return KeyOf(word[0]);
  float position = 0;
  const char* const end = word.data() + word.size();
  if (word.starts_with('=') &&
      std::from_chars(word.data() + 1, end, position) == std::from_chars_result{end, {}}) {
    return Key{.kind = Key::Kind::kPosition, .position = position};
  }
  return std::nullopt;
}

KeyInput::KeyInput() : terminal_(::isatty(STDIN_FILENO) == 1) {
  if (!terminal_ || ::tcgetattr(STDIN_FILENO, &before_) != 0) return;
  termios raw = before_;
  ::cfmakeraw(&raw);
  raw.c_oflag = before_.c_oflag;  // line feeds of messages still return the cursor
  ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

KeyInput::~KeyInput() {
  if (terminal_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::optional<Key> KeyInput::Next(bool done) {
  if (!terminal_) return done ? NextWord() : std::nullopt;
  std::array<char, 64> bytes;
  bool came = false;
  if (HasInput()) {
    const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count <= 0) return Key{.kind = Key::Kind::kQuit};  // the terminal is gone
    decoder_.Add({bytes.data(), static_cast<std::size_t>(count)});
    came = true;
  }
  return decoder_.Next(!came);
}

std::optional<Key> KeyInput::NextWord() {
  if (!HasInput()) return std::nullopt;
  std::string word;
  for (;;) {
    const auto c = ReadByte();
    if (!c && word.empty()) return Key{.kind = Key::Kind::kQuit};
    const bool space = !c || std::isspace(static_cast<unsigned char>(*c)) != 0;
    if (!space) word += *c;
    if (!space || word.empty()) continue;
    if (const auto key = KeyOfWord(word)) return key;
    throw app::BadInput("\"" + word +
                        "\" is no key; left, right, up, down, space, enter, quit, a letter or "
                        "=POSITION would be right");
  }
}

}  // namespace facewire::tools
