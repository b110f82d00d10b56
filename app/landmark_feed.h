#ifndef FACEWIRE_APP_LANDMARK_FEED_H_
#define FACEWIRE_APP_LANDMARK_FEED_H_

#include <cstddef>
#include <optional>

#include "core/base/time.h"
#include "core/landmarks.h"
#include "core/wire/landmark_part.h"

namespace facewire::app {

inline constexpr float kMostLandmarkPictures = 60;  // a second
inline constexpr Duration kLandmarkLease = std::chrono::seconds(5);

// Which landmarks go to a host that asked for them, and in which parts: one picture to its end,
// then the newest. Knows nothing about the line. Allocates nothing.
class LandmarkFeed {
 public:
  // From `now` on for kLandmarkLease, `pictures_a_second` of them; 0 ends it, also in the middle of
  // a picture. False, with nothing changed: not within 0..kMostLandmarkPictures.
  bool Ask(float pictures_a_second, Time now) noexcept;
  bool asked(Time now) const noexcept { return now < until_; }

  // What the newest picture shows (a count of 0: no face). Copied, unless the last one is still
  // under way or it is too early for another by the pictures' own times.
  void Offer(const Landmarks& newest) noexcept;

  // The next part, or nothing. Next goes on to the one after it.
  std::optional<wire::LandmarkPart> part() const noexcept;
  void Next() noexcept;

 private:
  Time until_{};
  Duration period_{};
  Landmarks picture_;
  std::size_t next_ = 0;  // the first landmark of the next part
  bool under_way_ = false;
  std::optional<Time> due_;  // no picture that was captured before
};

// How many bytes may go between two poses, so that the second need not wait: what the line has been
// seen to let go. Learns it by trying a part more now and then. Numbers: core/wire/README.md.
class SpareRoom {
 public:
  // Before each pose. `gone`: the line has let go of everything; `bytes`: taken since the pose
  // before.
  void Measure(bool gone, std::size_t bytes, Time now) noexcept;
  // Whether so many bytes may have been taken when the next pose comes.
  bool Has(std::size_t bytes) const noexcept { return open_ && bytes <= bytes_; }
  void Forget() noexcept { *this = {}; }

 private:
  bool open_ = false;
  std::size_t bytes_ = 0;
  Time grow_at_{};
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_LANDMARK_FEED_H_
