#ifndef FACEWIRE_HAL_GPIOD_SYSTEM_LIBRARY_H_
#define FACEWIRE_HAL_GPIOD_SYSTEM_LIBRARY_H_

#include "hal/gpiod/library.h"

namespace facewire::hal::gpiod {

// The calls that libgpiod 1 and 2 spell differently are in system_library_v1.cc and _v2.cc, one of
// which is built.
class LinkedLibrary final : public Library {
 public:
  std::vector<std::string> Chips() override;
  std::optional<ChipInfo> Describe(const std::string& path) override;
  std::unique_ptr<HeldLine> Take(const std::string& path, unsigned offset,
                                 const LineSettings& settings) override;
};

}  // namespace facewire::hal::gpiod

#endif  // FACEWIRE_HAL_GPIOD_SYSTEM_LIBRARY_H_
