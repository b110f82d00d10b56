#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_TEMPORARY_FILE_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_TEMPORARY_FILE_H_

#include <filesystem>
#include <functional>
#include <string>

namespace facewire::tools {

// Calls `check` with a file in `folder` that has this text, and is gone afterwards. The BadInput
// that `check` throws speaks of `name` instead of it. Throws Failure when it cannot be written.
void CheckAsFile(const std::filesystem::path& folder, const std::string& text,
                 const std::string& name,
                 const std::function<void(const std::filesystem::path&)>& check);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_TEMPORARY_FILE_H_
