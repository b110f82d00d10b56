#ifndef FACEWIRE_TOOLS_FACEWIRE_FULL_SCREEN_H_
#define FACEWIRE_TOOLS_FACEWIRE_FULL_SCREEN_H_

#include <cstdio>
#include <string_view>

namespace facewire::tools {

inline void WriteOut(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

// The other page of the terminal for as long as this lives, without a cursor: what was there before
// comes back at the end.
class FullScreen {
 public:
  FullScreen() { WriteOut("\x1b[?1049h\x1b[?25l"); }
  ~FullScreen() { WriteOut("\x1b[?25h\x1b[?1049l"); }
  FullScreen(const FullScreen&) = delete;
  FullScreen& operator=(const FullScreen&) = delete;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_FULL_SCREEN_H_
