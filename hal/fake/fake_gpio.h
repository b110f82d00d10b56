#ifndef FACEWIRE_HAL_FAKE_FAKE_GPIO_H_
#define FACEWIRE_HAL_FAKE_FAKE_GPIO_H_

#include "core/base/time.h"
#include "hal/clock.h"
#include "hal/fake/recording.h"
#include "hal/gpio.h"

namespace facewire::hal::fake {

// A line that a test holds. Not thread-safe.
class FakeGpioInput final : public GpioInput {
 public:
  Result<bool> Get() override {
    if (broken_) return fault_;
    return asserted_;
  }
  void Hold(bool asserted) noexcept { asserted_ = asserted; }
  // Every Get fails so until Repair.
  void Break(Errc fault) noexcept {
    broken_ = true;
    fault_ = fault;
  }
  void Repair() noexcept { broken_ = false; }

 private:
  bool asserted_ = false;
  bool broken_ = false;
  Errc fault_ = Errc::kIo;
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
    if (broken_) return fault_;
    if (asserted != asserted_) changes_.Add({.at = clock_.Now(), .asserted = asserted});
    asserted_ = asserted;
    return {};
  }
  bool asserted() const noexcept { return asserted_; }
  // Only real changes: setting the level that the line has already is none.
  const Recording<GpioChange, 64>& changes() const noexcept { return changes_; }
  void Break(Errc fault) noexcept {
    broken_ = true;
    fault_ = fault;
  }
  void Repair() noexcept { broken_ = false; }

 private:
  Clock& clock_;
  bool asserted_ = false;
  bool broken_ = false;
  Errc fault_ = Errc::kIo;
  Recording<GpioChange, 64> changes_;
};

}  // namespace facewire::hal::fake

#endif  // FACEWIRE_HAL_FAKE_FAKE_GPIO_H_
