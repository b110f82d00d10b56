#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_ASK_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_ASK_H_

#include <optional>
#include <string>

// Questions to whoever is at the standard input, line by line: a person or a script.
namespace facewire::tools {

// The answer without surrounding spaces; nullopt at the end of the input.
std::optional<std::string> AskLine(const std::string& question);
// "y" or "n" (or yes, no); an empty line and the end of the input are `usual`. Asks again when it
// is something else.
bool AskYes(const std::string& question, bool usual);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_ASK_H_
