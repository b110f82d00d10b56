#include "tools/facewire/neutral_taker.h"

#include <charconv>
#include <span>

#include "app/error.h"

namespace facewire::tools {
namespace {

constexpr std::int64_t kDefaultUs = 2'000'000;

}  // namespace

NeutralTaker::NeutralTaker(const std::string& option, const std::string& range)
    : option_(option + " " + range), memory_(retarget::NeutralCapture::RequiredBytes()) {
  if (!range.empty()) {
    const char* end = range.data() + range.size();
    const auto first = std::from_chars(range.data(), end, first_);
    const bool colon = first.ec == std::errc{} && first.ptr != end && *first.ptr == ':';
    const auto last = colon ? std::from_chars(first.ptr + 1, end, last_) : first;
    if (!colon || last.ec != std::errc{} || last.ptr != end || last_ <= first_) {
      throw app::BadInput(option_ + ": A:B would be right, frames A to B-1, with B above A");
    }
  }
  retarget::NeutralCaptureConfig config;
  config.duration = Duration::zero();
  config.min_frames = 1;
  config.max_stray_cm = 1e6F;
  config.max_turn_deg = 1e6F;
  arena_.emplace(std::span(memory_));
  if (!capture_.Configure(config, *arena_))
    throw app::Failure("the memory for the neutral is too small");
}

bool NeutralTaker::Add(const PerformanceFrame& moment) {
  seen_ = moment.frame + 1;
  const bool inside =
      last_ == 0 ? moment.t_us < kDefaultUs : moment.frame >= first_ && moment.frame < last_;
  if (inside && moment.face) capture_.Add(*moment.face);
  return last_ == 0 ? moment.t_us >= kDefaultUs : seen_ >= last_;
}

retarget::Neutral NeutralTaker::Take() {
  if (seen_ < last_) {
    throw app::BadInput(option_ + ": the recording has only " + std::to_string(seen_) + " frames");
  }
  const auto neutral = capture_.Finish();
  if (!neutral) throw app::BadInput("no face is seen in the frames of the neutral; choose others");
  return *neutral;
}

}  // namespace facewire::tools
