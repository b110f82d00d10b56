#include "hal/gpiod/find_line.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <utility>

#include "hal/posix/errors.h"

namespace facewire::hal::gpiod {
namespace {

std::string Text(const ChipInfo& chip) {
  return chip.label.empty() ? chip.name : chip.name + " (" + chip.label + ")";
}

std::string List(const std::vector<ChipInfo>& chips) {
  std::string text;
  for (const ChipInfo& chip : chips) text += (text.empty() ? "" : ", ") + Text(chip);
  return text;
}

Result<ChipInfo> Describe(Library& library, const std::string& path, std::string& reason) {
  if (auto chip = library.Describe(path)) return *std::move(chip);
  const Errc error = posix::OpenError(errno);
  switch (error) {
    case Errc::kNotFound:
      reason = "there is no GPIO chip " + path;
      break;
    case Errc::kPermission:
      reason = "no permission to open " + path + "; the user must be in its group";
      break;
    case Errc::kUnsupported:
      reason = path + " is not a GPIO chip";
      break;
    default:
      reason = path + " cannot be opened: " + Name(error);
  }
  return error;
}

// Those that the name fits; all for an empty one.
Result<std::vector<ChipInfo>> FindChips(Library& library, const std::string& name,
                                        std::string& reason) {
  if (name.find('/') != std::string::npos) {
    auto chip = Describe(library, name, reason);
    if (!chip) return chip.error();
    return std::vector<ChipInfo>{*std::move(chip)};
  }
  std::vector<ChipInfo> all;
  std::vector<ChipInfo> found;
  std::optional<Errc> unreadable;
  for (const std::string& path : library.Chips()) {
    auto chip = Describe(library, path, reason);
    if (!chip) {
      // One that goes at this moment is none.
      if (chip.error() != Errc::kNotFound) unreadable = chip.error();
      continue;
    }
    if (name.empty() || chip->name == name || chip->label == name) found.push_back(*chip);
    all.push_back(*std::move(chip));
  }
  if (found.empty()) {
    if (unreadable) return *unreadable;  // it may be that one
    reason = all.empty() ? "this machine has no GPIO chip"
                         : "there is no GPIO chip \"" + name + "\"; this machine has: " + List(all);
    return Errc::kNotFound;
  }
  return found;
}

Place At(const ChipInfo& chip, unsigned offset) {
  const LineInfo& line = chip.lines[offset];
  std::string text = "line " + std::to_string(offset) + " of " + Text(chip);
  if (!line.name.empty()) text = "line \"" + line.name + "\", " + text.substr(5);
  return {chip.path, offset, line, std::move(text)};
}

}  // namespace

std::optional<unsigned> OffsetOf(std::string_view line) noexcept {
  unsigned offset = 0;
  const char* end = line.data() + line.size();
  const auto [stopped, error] = std::from_chars(line.data(), end, offset);
  if (error != std::errc() || stopped != end) return std::nullopt;
  return offset;
}

Result<Place> FindLine(Library& library, const LineName& name, std::string& reason) {
  const std::optional<unsigned> offset = OffsetOf(name.line);
  if (offset && name.chip.empty()) {
    reason = "line " + name.line + " of which chip?";
    return Errc::kInvalidArgument;
  }
  const Result<std::vector<ChipInfo>> chips = FindChips(library, name.chip, reason);
  if (!chips) return chips.error();
  if (offset) {
    if (chips->size() > 1) {
      reason = "several GPIO chips are called \"" + name.chip + "\": " + List(*chips) +
               "; give the name or path of one";
      return Errc::kInvalidArgument;
    }
    const ChipInfo& chip = chips->front();
    if (*offset < chip.lines.size()) return At(chip, *offset);
    reason = Text(chip) + " has no line " + name.line + ", only 0 to " +
             std::to_string(std::max<std::size_t>(chip.lines.size(), 1) - 1);
    return Errc::kNotFound;
  }
  std::optional<Place> found;
  for (const ChipInfo& chip : *chips) {
    for (unsigned i = 0; i < chip.lines.size(); ++i) {
      if (chip.lines[i].name != name.line) continue;
      if (found) {
        reason = "several lines are called \"" + name.line + "\": " + found->text + ", and " +
                 At(chip, i).text + "; give one by its chip and number";
        return Errc::kInvalidArgument;
      }
      found = At(chip, i);
    }
  }
  if (found) return *std::move(found);
  reason = "no line is called \"" + name.line + "\" on " + List(*chips);
  return Errc::kNotFound;
}

}  // namespace facewire::hal::gpiod
