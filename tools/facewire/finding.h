#ifndef FACEWIRE_TOOLS_FACEWIRE_FINDING_H_
#define FACEWIRE_TOOLS_FACEWIRE_FINDING_H_

#include <cstdint>
#include <string>

namespace facewire::tools {

enum class Verdict : std::uint8_t {
  kOk,
  kWarn,
  kFail
};  // works; a part will not work; nothing will

// What the doctor says of one thing.
struct Finding {
  std::string what;
  Verdict verdict = Verdict::kOk;
  std::string found;
  std::string fix;  // a command, or what to do; empty when all is well
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_FINDING_H_
