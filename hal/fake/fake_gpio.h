#ifndef FACEWIRE_HAL_FAKE_FAKE_GPIO_H_
#define FACEWIRE_HAL_FAKE_FAKE_GPIO_H_

#include "core/base/time.h"
#include "hal/clock.h"
#include "hal/fake/recording.h"
#include "hal/gpio.h"

namespace facewire::hal::fake {

// Whether a line works. It is open from the beginning; once it was broken with kDisconnected it
// stays lost until it is repaired and opened again.
class FakeGpioState {
 public:
  Result<> Open() noexcept {
    ++opens_;
    if (broken_) return fault_;
    lost_ = false;
    return {};
  }
  // What a call on the line answers.
  Result<> Check() const noexcept {
    if (broken_) return fault_;
    if (lost_) return Errc::kDisconnected;
    return {};
  }
  void Break(Errc fault) noexcept {
    broken_ = true;
    fault_ = fault;
    lost_ = fault == Errc::kDisconnected;
  }
  void Repair() noexcept { broken_ = false; }
  int opens() const noexcept { return opens_; }

 private:
  bool broken_ = false;
  bool lost_ = false;
  Errc fault_ = Errc::kIo;
  int opens_ = 0;
};

// A line that a test holds. Not thread-safe.
class FakeGpioInput final : public GpioInput {
 public:
  Result<> Open() override { return state_.Open(); }
  std::string_view reason() const override { return {}; }
  Result<bool> Get() override {
    if (const Result<> works = state_.Check(); !works) return works.error();
    return asserted_;
  }
  void Hold(bool asserted) noexcept { asserted_ = asserted; }
  // Every call fails so until Repair.
  void Break(Errc fault) noexcept { state_.Break(fault); }
  void Repair() noexcept { state_.Repair(); }
  int opens() const noexcept { return state_.opens(); }  // tries

 private:
  bool asserted_ = false;
  FakeGpioState state_;
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

  Result<> Open() override { return state_.Open(); }
  std::string_view reason() const override { return {}; }
  Result<> Set(bool asserted) override {
    if (const Result<> works = state_.Check(); !works) return works.error();
    if (asserted != asserted_) changes_.Add({.at = clock_.Now(), .asserted = asserted});
    asserted_ = asserted;
    return {};
  }
  bool asserted() const noexcept { return asserted_; }
  // Only real changes: setting the level that the line has already is none.
  const Recording<GpioChange, 64>& changes() const noexcept { return changes_; }
  // Every call fails so until Repair.
  void Break(Errc fault) noexcept { state_.Break(fault); }
  void Repair() noexcept { state_.Repair(); }
  int opens() const noexcept { return state_.opens(); }  // tries

 private:
  Clock& clock_;
  bool asserted_ = false;
  FakeGpioState state_;
  Recording<GpioChange, 64> changes_;
};

}  // namespace facewire::hal::fake

#endif  // FACEWIRE_HAL_FAKE_FAKE_GPIO_H_
