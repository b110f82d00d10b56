#ifndef FACEWIRE_HAL_GPIOD_GPIOD_LINE_H_
#define FACEWIRE_HAL_GPIOD_GPIOD_LINE_H_

#include <memory>
#include <string>
#include <string_view>

#include "hal/gpio.h"
#include "hal/gpiod/find_line.h"
#include "hal/gpiod/library.h"

namespace facewire::hal::gpiod {

struct GpiodConfig {
  LineName name;
  bool active_low = false;  // asserted is the low level
  Bias bias = Bias::kAsIs;  // of an input
};

// What both directions share: the line is looked up and taken, and lost when its chip goes.
class TakenLine {
 public:
  TakenLine(GpiodConfig config, bool output, Library& library)
      : config_(std::move(config)), output_(output), library_(library) {}

  Result<> Take();  // as GpioLine::Open
  Result<bool> Get();
  Result<> Set(bool asserted);
  std::string_view reason() const noexcept { return reason_; }

 private:
  Errc Refused(int error, const Place& place);
  Errc Lost(int error) noexcept;

  GpiodConfig config_;
  bool output_;
  Library& library_;
  std::unique_ptr<HeldLine> held_;
  std::string said_;         // by Take
  std::string_view reason_;  // said_, or a text that needs no memory
};

class GpiodInput final : public GpioInput {
 public:
  // `library` is borrowed.
  explicit GpiodInput(GpiodConfig config, Library& library = SystemLibrary())
      : line_(std::move(config), false, library) {}
  Result<> Open() override { return line_.Take(); }
  Result<bool> Get() override { return line_.Get(); }
  std::string_view reason() const override { return line_.reason(); }

 private:
  TakenLine line_;
};

class GpiodOutput final : public GpioOutput {
 public:
  explicit GpiodOutput(GpiodConfig config, Library& library = SystemLibrary())
      : line_(std::move(config), true, library) {}
  GpiodOutput(const GpiodOutput&) = delete;
  GpiodOutput& operator=(const GpiodOutput&) = delete;
  ~GpiodOutput() override { (void)line_.Set(false); }
  Result<> Open() override { return line_.Take(); }
  Result<> Set(bool asserted) override { return line_.Set(asserted); }
  std::string_view reason() const override { return line_.reason(); }

 private:
  TakenLine line_;
};

}  // namespace facewire::hal::gpiod

#endif  // FACEWIRE_HAL_GPIOD_GPIOD_LINE_H_
