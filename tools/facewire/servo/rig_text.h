#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_RIG_TEXT_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_RIG_TEXT_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// Changes of a rig file that its writer would have made by hand: numbers are replaced where they
// stand, and every other byte stays, comments and alignment included.
namespace facewire::tools {

// In the servo's unit. What is absent stays as it is.
struct ServoEdit {
  std::optional<double> min{};
  std::optional<double> max{};
  std::optional<double> neutral{};
  // The map's ends, too, become min and max, and what is between them moves along; its direction
  // stays. min and max are then only written where the file has them already.
  bool map_ends = false;
  // Where neutral was: then the map takes it to the new one, each side stretched for itself, so
  // that a face at rest still rests there.
  std::optional<double> neutral_was{};
};

// `text` with the numbers in the [[servo]] of that name. Throws BadInput: not TOML, no such servo,
// or one that is written inline.
std::string EditServo(std::string_view text, std::string_view servo, const ServoEdit& edit);

// A position as the file has it: 1500, 1499.25.
std::string PositionText(double position);

// What LoadRig and LoadServoRig say about `text` as the rig of `file`. Throws BadInput.
void CheckRigText(const std::filesystem::path& file, const std::string& text);
// Checks it, then puts it in the place of `file`, whole or not at all. Throws BadInput, Failure;
// the file is as it was then.
void ReplaceRig(const std::filesystem::path& file, const std::string& text);
// Throws BadInput when `file` cannot be written: before a person has worked for nothing.
void RequireWritable(const std::filesystem::path& file);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_RIG_TEXT_H_
