#include "app/landmark_feed.h"

#include <algorithm>

#include "core/wire/message.h"

namespace facewire::app {
namespace {

// Between two tries of a part more than the line has let go in time.
constexpr Duration kTryAgain = std::chrono::seconds(5);

}  // namespace

bool LandmarkFeed::Ask(float pictures_a_second, Time now) noexcept {
  if (!(pictures_a_second >= 0 && pictures_a_second <= kMostLandmarkPictures)) return false;
  if (pictures_a_second == 0) {
    *this = {};
    return true;
  }
  if (!asked(now)) *this = {};
  until_ = now + kLandmarkLease;
  // One picture at least while the host asks.
  const float seconds = std::min(1 / pictures_a_second, Seconds(kLandmarkLease));
  period_ = Duration(static_cast<Duration::rep>(1e6F * seconds));
  return true;
}

void LandmarkFeed::Offer(const Landmarks& newest) noexcept {
  if (under_way_) return;
  // A camera's pictures do not come evenly. One that is far too early is of a clock that began
  // anew.
  const Duration early = due_ ? *due_ - newest.captured : Duration{};
  if (early > period_ / 4 && early < 2 * period_) return;
  // Due times are a fixed period apart, so that 10 of 24 pictures a second are 10; after a pause
  // they begin anew.
  const bool on_time = due_ && early > -period_ && early < 2 * period_;
  due_ = (on_time ? *due_ : newest.captured) + period_;
  picture_ = newest;
  next_ = 0;
  under_way_ = true;
}

std::optional<wire::LandmarkPart> LandmarkFeed::part() const noexcept {
  if (!under_way_) return std::nullopt;
  return wire::PartOf(picture_, next_);
}

void LandmarkFeed::Next() noexcept {
  next_ += wire::kMaxLandmarksInPart;
  under_way_ = next_ < picture_.count;
}

void SpareRoom::Measure(bool gone, std::size_t bytes, Time now) noexcept {
  const std::size_t part = wire::kLandmarkPartFrameBytes;
  if (gone && now >= grow_at_) {
    bytes_ = std::max(bytes_, bytes + part);
  } else if (!gone && open_ && bytes <= bytes_) {
    // Too much after all. (More than bytes_, or what was waiting before, was not of this making.)
    bytes_ -= std::min(bytes_, part);
    grow_at_ = now + kTryAgain;
  }
  open_ = gone;
}

}  // namespace facewire::app
