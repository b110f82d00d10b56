// libgpiod 2 (Debian 13: 2.2). A request stands alone; its chip's object is closed again.

#include <gpiod.h>

#include <cerrno>

#include "hal/gpiod/system_library.h"

namespace facewire::hal::gpiod {
namespace {

// Each of the library's objects has a function of its own that frees it.
template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* object) const noexcept {
    kFree(object);
  }
};
template <class T, auto kFree>
using Owned = std::unique_ptr<T, Free<kFree>>;
using Chip = Owned<gpiod_chip, gpiod_chip_close>;
using Request = Owned<gpiod_line_request, gpiod_line_request_release>;

class HeldLineV2 final : public HeldLine {
 public:
  HeldLineV2(Request request, unsigned offset) noexcept
      : request_(std::move(request)), offset_(offset) {}
  int Get() override { return gpiod_line_request_get_value(request_.get(), offset_); }
  int Set(bool asserted) override {
    return gpiod_line_request_set_value(
        request_.get(), offset_, asserted ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
  }

 private:
  Request request_;
  unsigned offset_;
};

std::string Text(const char* text) { return text == nullptr ? "" : text; }

gpiod_line_bias BiasOf(Bias bias) noexcept {
  switch (bias) {
    case Bias::kOff:
      return GPIOD_LINE_BIAS_DISABLED;
    case Bias::kPullUp:
      return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::kPullDown:
      return GPIOD_LINE_BIAS_PULL_DOWN;
    default:
      return GPIOD_LINE_BIAS_AS_IS;
  }
}

}  // namespace

std::optional<ChipInfo> LinkedLibrary::Describe(const std::string& path) {
  const Chip chip(gpiod_chip_open(path.c_str()));
  if (chip == nullptr) {
    // A node of another kind answers as one whose device has gone; version 1 tells them apart.
    if (errno == ENODEV && !gpiod_is_gpiochip_device(path.c_str())) errno = ENOTTY;
    return std::nullopt;
  }
  const Owned<gpiod_chip_info, gpiod_chip_info_free> about(gpiod_chip_get_info(chip.get()));
  if (about == nullptr) return std::nullopt;
  ChipInfo info{path,
                Text(gpiod_chip_info_get_name(about.get())),
                Text(gpiod_chip_info_get_label(about.get())),
                {}};
  const std::size_t count = gpiod_chip_info_get_num_lines(about.get());
  for (unsigned offset = 0; offset < count; ++offset) {
    const Owned<gpiod_line_info, gpiod_line_info_free> line(
        gpiod_chip_get_line_info(chip.get(), offset));
    if (line == nullptr) return std::nullopt;
    info.lines.push_back({Text(gpiod_line_info_get_name(line.get())),
                          gpiod_line_info_is_used(line.get()),
                          Text(gpiod_line_info_get_consumer(line.get()))});
  }
  return info;
}

std::unique_ptr<HeldLine> LinkedLibrary::Take(const std::string& path, unsigned offset,
                                              const LineSettings& settings) {
  const Chip chip(gpiod_chip_open(path.c_str()));
  if (chip == nullptr) return nullptr;
  const Owned<gpiod_line_settings, gpiod_line_settings_free> line(gpiod_line_settings_new());
  const Owned<gpiod_line_config, gpiod_line_config_free> lines(gpiod_line_config_new());
  const Owned<gpiod_request_config, gpiod_request_config_free> who(gpiod_request_config_new());
  if (line == nullptr || lines == nullptr || who == nullptr) return nullptr;
  gpiod_line_settings_set_active_low(line.get(), settings.active_low);
  gpiod_request_config_set_consumer(who.get(), kConsumer);
  const gpiod_line_direction direction =
      settings.output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT;
  if (gpiod_line_settings_set_direction(line.get(), direction) != 0 ||
      gpiod_line_settings_set_bias(line.get(), BiasOf(settings.bias)) != 0 ||
      gpiod_line_settings_set_output_value(line.get(), GPIOD_LINE_VALUE_INACTIVE) != 0 ||
      gpiod_line_config_add_line_settings(lines.get(), &offset, 1, line.get()) != 0) {
    return nullptr;
  }
  Request request(gpiod_chip_request_lines(chip.get(), who.get(), lines.get()));
  if (request == nullptr) return nullptr;
  return std::make_unique<HeldLineV2>(std::move(request), offset);
}

}  // namespace facewire::hal::gpiod
