#include "app/button.h"

#include <gtest/gtest.h>

#include <vector>

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using Press = Button::Press;

// A button that is looked at every 10 ms.
struct Context {
  // Holds the level for so long; what was pressed meanwhile, without kNone.
  std::vector<Press> Hold(bool down, milliseconds time) {
    std::vector<Press> presses;
    for (const Time end = now + time; now < end; now += milliseconds(10)) {
      const Press press = button.Update(down, now);
      if (press != Press::kNone) presses.push_back(press);
    }
    return presses;
  }
  Button button;
  Time now{};
};

using Presses = std::vector<Press>;

TEST(Button, TellsAShortPressWhenItEnds) {
  Context c;
  EXPECT_EQ(c.Hold(false, milliseconds(100)), Presses{});
  EXPECT_EQ(c.Hold(true, milliseconds(500)), Presses{});
  EXPECT_EQ(c.Hold(false, milliseconds(500)), Presses{Press::kShort});
}

TEST(Button, TellsALongPressWhileItIsHeldAndOnlyOnce) {
  Context c;
  c.Hold(false, milliseconds(100));
  EXPECT_EQ(c.Hold(true, milliseconds(1990)), Presses{});
  EXPECT_EQ(c.Hold(true, milliseconds(100)), Presses{Press::kLong});
  EXPECT_EQ(c.Hold(true, milliseconds(10'000)), Presses{});
  EXPECT_EQ(c.Hold(false, milliseconds(500)), Presses{});
  EXPECT_EQ(c.Hold(true, milliseconds(100)), Presses{});
  EXPECT_EQ(c.Hold(false, milliseconds(100)), Presses{Press::kShort}) << "and works again";
}

TEST(Button, ABouncingContactIsOnePress) {
  Context c;
  c.Hold(false, milliseconds(100));
  Presses all;
  const auto hold = [&](bool down, int ms) {
    for (const Press press : c.Hold(down, milliseconds(ms))) all.push_back(press);
  };
  for (int i = 0; i < 5; ++i) {
    hold(true, 10);
    hold(false, 20);
  }
  EXPECT_EQ(all, Presses{}) << "never steady";
  hold(true, 300);
  for (int i = 0; i < 5; ++i) {
    hold(false, 20);
    hold(true, 10);
  }
  hold(false, 300);
  EXPECT_EQ(all, Presses{Press::kShort});
}

TEST(Button, IsNotPressedByABlipHoweverRarelyItIsLookedAt) {
  Context c;
  for (int i = 0; i < 20; ++i) {
    const bool blip = i % 2 == 1;
    EXPECT_EQ(c.button.Update(blip, c.now), Press::kNone);
    c.now += milliseconds(50);
  }
}

TEST(Button, AStuckOneMeansNothing) {
  Context c;
  EXPECT_EQ(c.Hold(true, milliseconds(10'000)), Presses{}) << "down from the beginning";
  EXPECT_EQ(c.Hold(false, milliseconds(100)), Presses{});
  EXPECT_EQ(c.Hold(true, milliseconds(100)), Presses{});
  EXPECT_EQ(c.Hold(false, milliseconds(100)), Presses{Press::kShort});
}

TEST(Button, APressThatCouldNotBeReadToItsEndIsNone) {
  Context c;
  c.Hold(false, milliseconds(100));
  c.Hold(true, milliseconds(1900));
  c.button.Forget();
  EXPECT_EQ(c.Hold(true, milliseconds(3000)), Presses{});
  EXPECT_EQ(c.Hold(false, milliseconds(100)), Presses{});
}

}  // namespace
}  // namespace facewire::app
