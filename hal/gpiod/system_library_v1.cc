// libgpiod 1 (Debian 12: 1.6). A line belongs to its chip's object, which stays open with it.

#include <gpiod.h>

#include "hal/gpiod/system_library.h"

namespace facewire::hal::gpiod {
namespace {

struct CloseChip {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }  // and its lines
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

class HeldLineV1 final : public HeldLine {
 public:
  HeldLineV1(Chip chip, gpiod_line* line) noexcept : chip_(std::move(chip)), line_(line) {}
  int Get() override { return gpiod_line_get_value(line_); }
  int Set(bool asserted) override { return gpiod_line_set_value(line_, asserted ? 1 : 0); }

 private:
  Chip chip_;
  gpiod_line* line_;  // the chip's
};

std::string Text(const char* text) { return text == nullptr ? "" : text; }

int FlagsOf(const LineSettings& settings) noexcept {
  int flags = settings.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  switch (settings.bias) {
    case Bias::kAsIs:
      break;
    case Bias::kOff:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
      break;
    case Bias::kPullUp:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
      break;
    case Bias::kPullDown:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
      break;
  }
  return flags;
}

}  // namespace

std::optional<ChipInfo> LinkedLibrary::Describe(const std::string& path) {
  const Chip chip(gpiod_chip_open(path.c_str()));
  if (chip == nullptr) return std::nullopt;
  ChipInfo info{path, Text(gpiod_chip_name(chip.get())), Text(gpiod_chip_label(chip.get())), {}};
  const unsigned count = gpiod_chip_num_lines(chip.get());
  for (unsigned offset = 0; offset < count; ++offset) {
    gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
    if (line == nullptr) return std::nullopt;
    info.lines.push_back(
        {Text(gpiod_line_name(line)), gpiod_line_is_used(line), Text(gpiod_line_consumer(line))});
  }
  return info;
}

std::unique_ptr<HeldLine> LinkedLibrary::Take(const std::string& path, unsigned offset,
                                              const LineSettings& settings) {
  Chip chip(gpiod_chip_open(path.c_str()));
  if (chip == nullptr) return nullptr;
  gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
  if (line == nullptr) return nullptr;
  const gpiod_line_request_config config{.consumer = kConsumer,
                                         .request_type = settings.output
                                                             ? GPIOD_LINE_REQUEST_DIRECTION_OUTPUT
                                                             : GPIOD_LINE_REQUEST_DIRECTION_INPUT,
                                         .flags = FlagsOf(settings)};
  if (gpiod_line_request(line, &config, 0) != 0) return nullptr;
  return std::make_unique<HeldLineV1>(std::move(chip), line);
}

}  // namespace facewire::hal::gpiod
