#ifndef FACEWIRE_TESTS_HAL_GPIOD_FAKE_CHIPS_H_
#define FACEWIRE_TESTS_HAL_GPIOD_FAKE_CHIPS_H_

#include <algorithm>
#include <cerrno>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hal/gpiod/library.h"

namespace facewire::hal::gpiod {

// GPIO chips that a test makes, and that fail on demand.
class FakeChips final : public Library {
 public:
  struct Line {
    bool held = false;
    LineSettings settings;  // of who holds it, or held it last
    bool asserted = false;
  };

  // `names` are the lines' names by offset.
  void AddChip(const std::string& name, const std::string& label,
               const std::vector<std::string>& names) {
    ChipInfo chip{"/dev/" + name, name, label, {}};
    for (const std::string& line : names) chip.lines.push_back({line, false, ""});
    chips.push_back(std::move(chip));
  }
  Line& At(const std::string& path, unsigned offset) { return lines[{path, offset}]; }

  std::vector<std::string> Chips() override {
    std::vector<std::string> paths;
    for (const ChipInfo& chip : chips) paths.push_back(chip.path);
    return paths;
  }
  std::optional<ChipInfo> Describe(const std::string& path) override {
    const auto chip = std::ranges::find(chips, path, &ChipInfo::path);
    if (chip == chips.end()) {
      errno = ENOENT;
      return std::nullopt;
    }
    if (const int error = describe_errors[path]; error != 0) {
      errno = error;
      return std::nullopt;
    }
    return *chip;
  }
  std::unique_ptr<HeldLine> Take(const std::string& path, unsigned offset,
                                 const LineSettings& settings) override {
    if (take_error != 0) {
      errno = take_error;
      return nullptr;
    }
    Line& line = At(path, offset);
    if (line.held) {
      errno = EBUSY;
      return nullptr;
    }
    line.held = true;
    line.settings = settings;
    if (settings.output) line.asserted = false;
    return std::make_unique<Held>(*this, line);
  }

  std::vector<ChipInfo> chips;
  std::map<std::pair<std::string, unsigned>, Line> lines;
  std::map<std::string, int> describe_errors;  // by path
  int take_error = 0;                          // 0: none
  int use_error = 0;                           // of reading and setting

 private:
  class Held final : public HeldLine {
   public:
    Held(FakeChips& chips, Line& line) : chips_(chips), line_(line) {}
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;
    ~Held() override { line_.held = false; }
    int Get() override {
      if (chips_.use_error == 0) return line_.asserted ? 1 : 0;
      errno = chips_.use_error;
      return -1;
    }
    int Set(bool asserted) override {
      if (chips_.use_error == 0) {
        line_.asserted = asserted;
        return 0;
      }
      errno = chips_.use_error;
      return -1;
    }

   private:
    FakeChips& chips_;
    Line& line_;
  };
};

}  // namespace facewire::hal::gpiod

#endif  // FACEWIRE_TESTS_HAL_GPIOD_FAKE_CHIPS_H_
