#ifndef FACEWIRE_APP_NEUTRAL_FILE_H_
#define FACEWIRE_APP_NEUTRAL_FILE_H_

#include <filesystem>

#include "app/file_calls.h"
#include "core/retarget/neutral.h"

namespace facewire::app {

// The performer's neutral, kept across boots (format in app/formats.md).

// BadInput, one line: missing, not a neutral, truncated, damaged, of another version, not finite.
retarget::Neutral LoadNeutral(const std::filesystem::path& path);

// Atomically. Failure: cannot write.
void SaveNeutral(const std::filesystem::path& path, const retarget::Neutral& neutral,
                 FileCalls& files = LinuxFiles());

}  // namespace facewire::app

#endif  // FACEWIRE_APP_NEUTRAL_FILE_H_
