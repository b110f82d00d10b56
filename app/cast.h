#ifndef FACEWIRE_APP_CAST_H_
#define FACEWIRE_APP_CAST_H_

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/character.h"
#include "app/config.h"
#include "app/profile_file.h"
#include "app/report.h"
#include "core/base/arena.h"

namespace facewire::app {

// The character that runs, the one that a reload builds beside it, and the profiles that both read.
class Cast {
 public:
  // What Load takes from its arena at most.
  static std::size_t RequiredBytes() noexcept;

  // Loads the profiles and builds the first character. Once. Throws BadInput with every problem on
  // a line of its own; Failure.
  void Load(const CharacterConfig& config, Arena& arena);

  Character& running() { return *characters_[running_]; }

  // Reads the rig anew, into a character beside the running one; profiles stay as they are. A blend
  // that was set live stays, unless the configuration has another one than before. Throws BadInput,
  // Failure; the running one is not touched.
  Character& Prepare(const CharacterConfig& config);
  // What was prepared with this configuration is the running one from now on.
  void Switch(const CharacterConfig& config);

  // A line each for the rig and for both profiles, for a person.
  std::string Summary() const;
  void AddTo(MemoryReport& report) const;

 private:
  void Build(const CharacterConfig& config, std::size_t which);
  std::vector<std::string> SignalNames() const;
  std::string PersonalSummary() const;

  CharacterConfig config_;
  std::unique_ptr<Profile> profile_;   // or none: bones only
  std::unique_ptr<Profile> personal_;  // or none
  std::array<std::span<std::byte>, 2> memory_;
  std::array<std::optional<Character>, 2> characters_;
  std::size_t running_ = 0;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CAST_H_
