#include "core/base/time.h"

#include <gtest/gtest.h>

namespace facewire {
namespace {

using std::chrono::microseconds;

TEST(Between, IsTheDifferenceWhereItFits) {
  EXPECT_EQ(Between(Time(microseconds(3)), Time(microseconds(10))), microseconds(7));
  EXPECT_EQ(Between(Time(microseconds(10)), Time(microseconds(3))), microseconds(-7));
  EXPECT_EQ(Between(Time(microseconds(-1)), Time::max() - microseconds(1)), Duration::max());
  EXPECT_EQ(Between(Time(microseconds(1)), Time::min() + microseconds(1)), Duration::min());
}

TEST(Between, StopsAtTheEndsInsteadOfOverflowing) {
  EXPECT_EQ(Between(Time::min(), Time::max()), Duration::max());
  EXPECT_EQ(Between(Time::max(), Time::min()), Duration::min());
  EXPECT_EQ(Between(Time(microseconds(-1)), Time::max()), Duration::max());
}

}  // namespace
}  // namespace facewire
