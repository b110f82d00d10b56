#ifndef FACEWIRE_HAL_FAKE_FAKE_GPIO_H_
#define FACEWIRE_HAL_FAKE_FAKE_GPIO_H_

#include <optional>

#include "core/base/time.h"
#include "hal/clock.h"
#include "hal/fake/recording.h"
#include "hal/gpio.h"

namespace facewire::hal::fake {

// A line that a test holds. Not thread-safe.
class FakeGpioInput final : public GpioInput {
 public:
  Result<bool> Get() override {
    if (fault_) return *fault_;
    return asserted_;
  }
  void Hold(bool asserted) noexcept { asserted_ = asserted; }
  // Every Get fails so until Repair.
  void Break(Errc fault) noexcept { fault_ = fault; }
  void Repair() noexcept { fault_.reset(); }

 private:
  bool asserted_ = false;
  std::optional<Errc> fault_;
};

struct GpioChange {
  Time at{};
  bool asserted = false;
};

// A line that remembers when it changed. Starts released. Not thread-safe.
class FakeGpioOutput final : public GpioOutput {
 public:
  // `clock` is borrowed for the line's life.
  explicit FakeGpioOutput(Clock& clock) noexcept : clock_(clock) {}

  Result<> Set(bool asserted) override {
    if (fault_) return *fault_;
    if (asserted != asserted_) changes_.Add({.at = clock_.Now(), .asserted = asserted});
    asserted_ = asserted;
    return {};
  }
  bool asserted() const noexcept { return asserted_; }
  // Only real changes: setting the level that the line has already is none.
  const Recording<GpioChange, 64>& changes() const noexcept { return changes_; }
  void Break(Errc fault) noexcept { fault_ = fault; }
  void Repair() noexcept { fault_.reset(); }

 private:
  Clock& clock_;
  bool asserted_ = false;
  std::optional<Errc> fault_;
  Recording<GpioChange, 64> changes_;
};

}  // namespace facewire::hal::fake

#endif  // FACEWIRE_HAL_FAKE_FAKE_GPIO_H_
