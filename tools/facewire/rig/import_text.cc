#include "tools/facewire/rig/import_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

#include "tools/facewire/rig/rig_names.h"
#include "tools/facewire/rig/shape_names.h"

namespace facewire::tools::rig {
namespace {

constexpr std::size_t kLineLength = 110;

// As few digits as say it: 0.35, 22, -1.5.
std::string Number(double value, int digits = 3) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  std::string number = text.data();
  if (digits > 0) number.erase(number.find_last_not_of('0') + 1);
  if (number.ends_with('.')) number.pop_back();
  return number == "-0" ? "0" : number;
}

std::string DriveText(const Drives& drives) {
  std::string text;
  for (const auto& [signal, gain] : drives) {
    const bool quoted = signal.find('.') != std::string::npos;
    text += text.empty() ? "{ " : ", ";
    text += (quoted ? "\"" + signal + "\"" : signal) + " = " + Number(gain);
  }
  return text + " }";
}

// Whole numbers, where they are large enough: nobody wants 17.392.
std::string Speed(double value) { return Number(value, value >= 10 ? 0 : 2); }

std::string AxisText(const PlannedAxis& axis) {
  std::string text = axis.name + " = { min = " + Number(axis.min, 2) +
                     ", max = " + Number(axis.max, 2) + ", max_speed = " + Speed(axis.max_speed) +
                     ", max_acceleration = " + Speed(axis.max_acceleration);
  if (axis.hard) text += ", knee = 0";
  if (!axis.drives.empty()) text += ", drive = " + DriveText(axis.drives);
  return text + " }\n";
}

// Words in lines of comments behind `first`.
std::string Wrapped(const std::string& first, std::span<const std::string> words) {
  std::string text, line = "# " + first;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = Shown(words[i]) + (i + 1 < words.size() ? "," : "");
    if (line.size() + 1 + word.size() > kLineLength) {
      text += line + "\n";
      line = "#  ";
    }
    line += " " + word;
  }
  return text + line + "\n";
}

std::string Quoted(const std::string& name) { return "\"" + name + "\""; }

std::string BoneText(const PlannedBone& bone) {
  std::string text = "\n# " + bone.why;
  if (bone.name != bone.original) text += "; in the file: " + Shown(bone.original);
  text += "\n[[bone]]\nname = " + Quoted(bone.name) + "\n";
  const std::string& landmark = bone.role.landmark;
  if (!landmark.empty()) {
    const bool number = landmark[0] >= '0' && landmark[0] <= '9';
    text += "landmark = " + (number ? landmark : Quoted(landmark)) + "\n";
  }
  text += "rest_cm = [" + Number(static_cast<double>(bone.rest_cm.x)) + ", " +
          Number(static_cast<double>(bone.rest_cm.y)) + ", " +
          Number(static_cast<double>(bone.rest_cm.z)) + "]\n";
  if (!bone.done_by.empty())
    text += "# Moved by " + bone.done_by + " already; with these lines it would move twice:\n";
  for (const PlannedAxis& axis : bone.axes)
    text += (bone.done_by.empty() ? "" : "# ") + AxisText(axis);
  return text;
}

std::string ParameterText(const PlannedParameter& parameter) {
  std::string text = "\n# " + parameter.why;
  if (parameter.name != parameter.original) text += "; in the file: " + Shown(parameter.original);
  text += "\n[[parameter]]\nname = " + Quoted(parameter.name) + "\n";
  const bool own_signal = parameter.drives.size() == 1 &&
                          parameter.drives[0].first == parameter.name &&
                          parameter.drives[0].second == 1;
  if (!own_signal) text += "drive = " + DriveText(parameter.drives) + "\n";
  return text + "max_speed = 25\n";
}

const char* NameOf(Convention convention) {
  switch (convention) {
    case Convention::kVrm0:
      return "VRM 0";
    case Convention::kVrm1:
      return "VRM 1";
    case Convention::kGltf:
      break;
  }
  return "glTF";
}

std::string Count(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::size_t ShownOf(const ImportPlan& plan) { return ArkitShapes().size() - plan.lacking.size(); }

std::string UnitText(const ImportPlan& plan) {
  if (plan.cm_per_unit == 100) return "metres";
  if (plan.cm_per_unit == 1) return "centimetres";
  if (plan.cm_per_unit == 0.1) return "millimetres";
  return Number(plan.cm_per_unit) + " cm";
}

}  // namespace

bool IsEmpty(const ImportPlan& plan) {
  return plan.parameters.empty() && std::ranges::all_of(plan.bones, [](const PlannedBone& bone) {
           return bone.axes.empty() || !bone.done_by.empty();
         });
}

std::string RigText(const ImportPlan& plan, const Character& character, const std::string& source) {
  std::string text = "# Made by `facewire rig import` from " + Shown(source) + " (" +
                     NameOf(character.convention) + ", in " + UnitText(plan) + ").\n";
  text +=
      "# A proposal to be edited: ranges and speeds are those of a person's face and of the "
      "example rig,\n"
      "# otto.toml, which explains every key. `facewire rig check` says what is missing, `facewire "
      "rig show`\n"
      "# draws it. Names are the file's own, so a host finds its bones and shapes by them.\n";
  if (plan.turned)
    text +=
        "# The character faces -z there; here, as in every rig, it faces +z with its left at +x. A "
        "host\n"
        "# turns offsets back: x and z change their signs, and so do pitch and roll.\n";
  if (plan.parameters.empty()) {
    text +=
        "#\n# It has no blend shape that a signal of ARKit's drives; bones have to do it all.\n";
  } else if (!plan.lacking.empty()) {
    text += "#\n" + Wrapped("ARKit's shapes that it lacks:", plan.lacking);
  }
  if (!plan.notes.empty()) {
    text += "#\n# Not used:\n";
    for (const std::string& note : plan.notes) text += "#   " + note + "\n";
  }
  if (!plan.unknown_shapes.empty())
    text +=
        "#\n" + Wrapped(
                    "Shapes that no known name says anything about; a [[parameter]] with a drive "
                    "uses one:",
                    plan.unknown_shapes);
  if (!plan.other_bones.empty())
    text += "#\n" + Wrapped("Bones that are not of the face, or of which nothing is known:",
                            plan.other_bones);
  text += "\nname = " + Quoted(plan.name) + "\n";
  for (const PlannedBone& bone : plan.bones) text += BoneText(bone);
  for (const PlannedParameter& parameter : plan.parameters) text += ParameterText(parameter);
  return text;
}

std::string SummaryText(const ImportPlan& plan, const Character& character) {
  std::string text = std::string(NameOf(character.convention)) + " in " + UnitText(plan) +
                     (plan.turned ? ", turned to face +z" : "") + ": " +
                     Count(character.shapes.size(), "shape") + ", " +
                     Count(character.expressions.size(), "VRM expression") + ", " +
                     Count(character.nodes.size(), "node") + "\n";
  text += "ARKit's shapes: " + std::to_string(ShownOf(plan)) + " of " +
          std::to_string(ArkitShapes().size()) + " shown, by " +
          Count(plan.parameters.size(), "parameter") + "\n";
  const auto line = [](const std::string& what, const std::string& why) {
    std::string padded = "  " + Shown(what);
    padded.resize(std::max<std::size_t>(padded.size(), 30), ' ');
    return padded + "  " + why + "\n";
  };
  // One line for the many that need no thought.
  std::size_t exact = 0;
  for (const PlannedParameter& parameter : plan.parameters) {
    if (parameter.why == Describe(Match::kExact)) {
      ++exact;
    } else {
      text += line(parameter.original, DriveText(parameter.drives) + ", " + parameter.why);
    }
  }
  if (exact > 0) text += line(Count(exact, "shape"), Describe(Match::kExact));
  text += "bones: " + std::to_string(plan.bones.size()) + "\n";
  for (const PlannedBone& bone : plan.bones)
    text += line(bone.original,
                 bone.why + (bone.done_by.empty() ? std::string()
                                                  : ", left still: " + bone.done_by + " moves it"));
  const auto list = [&](const std::string& what, const std::vector<std::string>& names) {
    if (names.empty()) return;
    constexpr std::size_t kMost = 60;
    text += what + ":";
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) text += " " + Shown(names[i]);
    if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
    text += "\n";
  };
  if (!plan.parameters.empty()) list("lacks", plan.lacking);
  for (const std::string& note : plan.notes) text += "not used: " + note + "\n";
  list("unknown shapes", plan.unknown_shapes);
  if (!plan.other_bones.empty())
    text += "other bones: " + std::to_string(plan.other_bones.size()) + "\n";
  return text;
}

}  // namespace facewire::tools::rig
