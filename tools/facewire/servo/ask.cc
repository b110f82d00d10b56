#include "tools/facewire/servo/ask.h"

#include <unistd.h>

#include "tools/facewire/full_screen.h"

namespace facewire::tools {

std::optional<std::string> AskLine(const std::string& question) {
  WriteOut(question);
  std::string line;
  char c = 0;
  // Byte by byte: what comes after the line may be keys for another reader.
  for (;;) {
    if (::read(STDIN_FILENO, &c, 1) != 1) {
      if (line.empty()) return std::nullopt;
      break;
    }
    if (c == '\n') break;
    line += c;
  }
  // A script's answers do not show by themselves.
  if (::isatty(STDIN_FILENO) == 0) WriteOut(line + "\n");
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

bool AskYes(const std::string& question, bool usual) {
  for (;;) {
    const auto answer = AskLine(question + (usual ? " [Y/n] " : " [y/N] "));
    if (!answer || answer->empty()) return usual;
    if (*answer == "y" || *answer == "yes") return true;
    if (*answer == "n" || *answer == "no") return false;
  }
}

}  // namespace facewire::tools
