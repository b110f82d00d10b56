#ifndef FACEWIRE_HAL_GPIOD_LIBRARY_H_
#define FACEWIRE_HAL_GPIOD_LIBRARY_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace facewire::hal::gpiod {

// What holds an input's level while nothing drives it.
enum class Bias : std::uint8_t { kAsIs, kOff, kPullUp, kPullDown };

struct LineInfo {
  std::string name;      // empty: the board gives it none
  bool used = false;     // by a program or by the kernel
  std::string consumer;  // who uses it; may be empty
};

struct ChipInfo {
  std::string path;             // "/dev/gpiochip0"
  std::string name;             // "gpiochip0"; may be another after a restart
  std::string label;            // the driver's name for the hardware, "pinctrl-bcm2711"
  std::vector<LineInfo> lines;  // by offset
};

struct LineSettings {
  bool output = false;  // begins not asserted
  bool active_low = false;
  Bias bias = Bias::kAsIs;
};

// A line that was taken. Destruction gives it back to the kernel as it is.
class HeldLine {
 public:
  virtual ~HeldLine() = default;
  // 0 or 1: whether it is asserted; -1 with errno.
  virtual int Get() = 0;
  // 0; -1 with errno.
  virtual int Set(bool asserted) = 0;
};

// What this backend asks of libgpiod, whichever version: as narrow as it is. Tests put chips of
// their own here.
class Library {
 public:
  virtual ~Library() = default;
  // The paths of all chips' nodes, in order.
  virtual std::vector<std::string> Chips() = 0;
  // The chip behind a node; none with errno.
  virtual std::optional<ChipInfo> Describe(const std::string& path) = 0;
  // Takes a line of it, with "facewire" as its consumer; null with errno.
  virtual std::unique_ptr<HeldLine> Take(const std::string& path, unsigned offset,
                                         const LineSettings& settings) = 0;
};

// The one that this program is linked with, on the running kernel.
Library& SystemLibrary() noexcept;

// Who holds the lines that this program holds.
inline constexpr const char* kConsumer = "facewire";

}  // namespace facewire::hal::gpiod

#endif  // FACEWIRE_HAL_GPIOD_LIBRARY_H_
