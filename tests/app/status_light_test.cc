#include "app/status_light.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using S = ServiceState;

struct Shown {
  S state;
  bool calibrating;
};

constexpr Shown kAll[] = {
    {S::kStarting, false}, {S::kSearching, false}, {S::kTracking, false},
    {S::kHolding, false},  {S::kEasing, false},    {S::kResting, false},
    {S::kStopped, false},  {S::kFault, false},     {S::kTracking, true},
};

// What somebody sees who looks every so often.
std::string Seen(const Shown& shown, Duration every, Duration time) {
  std::string seen;
  for (Duration at{}; at < time; at += every) {
    seen += StatusLight(shown.state, shown.calibrating, at) ? '#' : '.';
  }
  return seen;
}

TEST(StatusLight, ShowsThePatternsOfTheTable) {
  const std::map<std::string, Shown> table = {
      {"###..###..###..###..", {S::kStarting, false}},
      {"##########..........", {S::kSearching, false}},
      {"####################", {S::kTracking, false}},
      {"########..########..", {S::kHolding, false}},
      {"#...................", {S::kResting, false}},
      {"##.##..........##.##", {S::kStopped, false}},
      {"#.#.#.#.#.#.#.#.#.#.", {S::kFault, false}},
      {"##.##.##.......##.##", {S::kSearching, true}},
  };
  for (const auto& [pattern, shown] : table) {
    EXPECT_EQ(Seen(shown, milliseconds(100), seconds(2)), pattern) << Name(shown.state);
  }
}

TEST(StatusLight, BeginsWithAFlash) {
  for (const Shown& shown : kAll) {
    EXPECT_TRUE(StatusLight(shown.state, shown.calibrating, {})) << Name(shown.state);
  }
}

TEST(StatusLight, HasNoPartThatFallsBetweenTwoTicks) {
  for (const Shown& shown : kAll) {
    const std::string seen = Seen(shown, milliseconds(1), seconds(12));
    for (std::size_t i = 0; i < seen.size();) {
      const std::size_t end = std::min(seen.find(seen[i] == '#' ? '.' : '#', i), seen.size());
      if (end < seen.size()) {
        EXPECT_GE(milliseconds(end - i), kShortestFlash) << Name(shown.state) << " at " << i;
      }
      i = end;
    }
  }
}

TEST(StatusLight, TellsWhatIsDifferentWithinFourSeconds) {
  std::map<std::string, std::string> known;
  for (const Shown& shown : kAll) {
    const std::string name = shown.calibrating           ? "calibrating"
                             : shown.state == S::kEasing ? Name(S::kHolding)
                                                         : Name(shown.state);
    const auto [first, fresh] = known.emplace(Seen(shown, milliseconds(50), seconds(4)), name);
    EXPECT_TRUE(fresh || first->second == name) << name << " looks like " << first->second;
  }
}

TEST(StatusLight, StopAndFaultAreShownWhateverElseGoesOn) {
  for (Duration at{}; at < seconds(3); at += milliseconds(10)) {
    EXPECT_EQ(StatusLight(S::kStopped, true, at), StatusLight(S::kStopped, false, at));
    EXPECT_EQ(StatusLight(S::kFault, true, at), StatusLight(S::kFault, false, at));
  }
}

TEST(StatusLight, RunsForMonths) {
  const Duration year = std::chrono::hours(24 * 365);
  EXPECT_TRUE(StatusLight(S::kTracking, false, year));
  const Duration rest = year - year % milliseconds(4000);
  EXPECT_TRUE(StatusLight(S::kResting, false, rest));
  EXPECT_FALSE(StatusLight(S::kResting, false, rest + milliseconds(200)));
}

}  // namespace
}  // namespace facewire::app
