#include "core/wire/osc_host/line_share.h"

#include <gtest/gtest.h>

namespace facewire::wire::osc_host {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(LineShare, GrowsWithTheTimeToFifteenSixteenthsOfTheLine) {
  LineShare share(160'000);  // 16000 bytes a second
  Time now{seconds(5)};
  share.Advance(now);
  share.Charge(share.left());
  EXPECT_EQ(share.left(), 0U);
  now += milliseconds(10);
  share.Advance(now);
  EXPECT_EQ(share.left(), 150U);
}

TEST(LineShare, NeverHasMoreThanATickOfTheSlowestRate) {
  LineShare share(160'000);
  share.Advance(Time{});
  EXPECT_EQ(share.left(), 750U);
  share.Advance(Time{seconds(3600)});
  EXPECT_EQ(share.left(), 750U);
}

TEST(LineShare, PaysADebtBeforeItGivesMore) {
  LineShare share(160'000);
  share.Advance(Time{});
  share.Charge(750 + 300);
  EXPECT_EQ(share.left(), 0U);
  share.Advance(Time{milliseconds(20)});
  EXPECT_EQ(share.left(), 0U);
  share.Advance(Time{milliseconds(30)});
  EXPECT_EQ(share.left(), 150U);
}

TEST(LineShare, LosesNothingBetweenShortTicks) {
  LineShare share(9600);  // 900 bytes a second
  share.Advance(Time{});
  share.Charge(share.left());
  for (int ms = 1; ms <= 100; ++ms) share.Advance(Time{milliseconds(ms)});
  EXPECT_EQ(share.left(), 90U);
}

TEST(LineShare, TimeThatStepsBackGivesNothing) {
  LineShare share(160'000);
  share.Advance(Time{seconds(10)});
  share.Charge(share.left());
  share.Advance(Time{seconds(1)});
  EXPECT_EQ(share.left(), 0U);
}

}  // namespace
}  // namespace facewire::wire::osc_host
