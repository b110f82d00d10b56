#ifndef FACEWIRE_TOOLS_FACEWIRE_NEUTRAL_TAKER_H_
#define FACEWIRE_TOOLS_FACEWIRE_NEUTRAL_TAKER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/arena.h"
#include "core/retarget/neutral_capture.h"
#include "tools/facewire/performance.h"

namespace facewire::tools {

// Takes the face at rest from chosen frames of a recording: the median of frames A to B-1 ("A:B"),
// or, when nothing is chosen, of the first two seconds. Whoever names frames means them: no frame
// is refused for being lively, unlike in the service.
class NeutralTaker {
 public:
  // Throws BadInput for anything but "" and "A:B" with B above A; `option` is named in messages.
  NeutralTaker(const std::string& option, const std::string& range);

  // Call with every frame from the first on, until it returns true: the last one of the range was
  // seen.
  bool Add(const PerformanceFrame& moment);
  // Throws BadInput when the recording ended before the range did, or showed no face in it.
  retarget::Neutral Take();

 private:
  std::string option_;
  std::uint64_t first_ = 0;
  std::uint64_t last_ = 0;  // 0: by time
  std::uint64_t seen_ = 0;  // frames
  std::vector<std::byte> memory_;
  std::optional<Arena> arena_;
  retarget::NeutralCapture capture_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_NEUTRAL_TAKER_H_
