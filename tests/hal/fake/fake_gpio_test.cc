#include "hal/fake/fake_gpio.h"

#include <gtest/gtest.h>

#include "hal/fake/fake_clock.h"

namespace facewire::hal::fake {
namespace {

using std::chrono::milliseconds;

TEST(FakeGpioInput, GivesTheLevelThatIsHeldAndTheFaultThatIsSet) {
  FakeGpioInput line;
  EXPECT_EQ(line.Get(), false);
  line.Hold(true);
  EXPECT_EQ(line.Get(), true);
  line.Break(Errc::kIo);
  EXPECT_EQ(line.Get().error(), Errc::kIo);
  line.Repair();
  EXPECT_EQ(line.Get(), true);
}

TEST(FakeGpioInput, ALostLineIsBackOnlyOnceItWasOpened) {
  FakeGpioInput line;
  line.Break(Errc::kDisconnected);
  EXPECT_EQ(line.Open().error(), Errc::kDisconnected);
  line.Repair();
  EXPECT_EQ(line.Get().error(), Errc::kDisconnected);
  EXPECT_TRUE(line.Open());
  EXPECT_EQ(line.Get(), false);
  EXPECT_EQ(line.opens(), 2);
}

TEST(FakeGpioOutput, RemembersChangesWithTheirTimesAndNothingElse) {
  FakeClock clock;
  FakeGpioOutput line(clock);
  ASSERT_TRUE(line.Set(false));
  clock.Advance(milliseconds(10));
  ASSERT_TRUE(line.Set(true));
  clock.Advance(milliseconds(10));
  ASSERT_TRUE(line.Set(true));
  ASSERT_TRUE(line.Set(false));
  ASSERT_EQ(line.changes().size(), 2U);
  EXPECT_EQ(line.changes()[0].at, Time{milliseconds(10)});
  EXPECT_TRUE(line.changes()[0].asserted);
  EXPECT_EQ(line.changes()[1].at, Time{milliseconds(20)});
}

TEST(FakeGpioOutput, ABrokenLineKeepsItsLevel) {
  FakeClock clock;
  FakeGpioOutput line(clock);
  line.Break(Errc::kIo);
  EXPECT_EQ(line.Set(true).error(), Errc::kIo);
  EXPECT_FALSE(line.asserted());
  EXPECT_EQ(line.changes().total(), 0U);
}

}  // namespace
}  // namespace facewire::hal::fake
