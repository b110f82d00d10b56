#include "hal/system_clock.h"

#include <gtest/gtest.h>
#include <sys/time.h>

#include <chrono>
#include <csignal>

namespace facewire::hal {
namespace {

using std::chrono::milliseconds;

TEST(SystemClock, IsTheMonotonicClockOfTheSystem) {
  SystemClock clock;
  const auto before =
      std::chrono::floor<Duration>(std::chrono::steady_clock::now().time_since_epoch());
  const Duration now = clock.Now().time_since_epoch();
  const auto after =
      std::chrono::ceil<Duration>(std::chrono::steady_clock::now().time_since_epoch());
  EXPECT_LE(before, now);
  EXPECT_LE(now, after);
}

TEST(SystemClock, SleepsToTheTimeAndNotLess) {
  SystemClock clock;
  const Time until = clock.Now() + milliseconds(20);
  clock.SleepUntil(until);
  EXPECT_GE(clock.Now(), until);
}

TEST(SystemClock, ATimeThatHasPassedIsNoSleep) {
  SystemClock clock;
  clock.SleepUntil(Time{milliseconds(-5)});
  clock.SleepUntil(Time{});
  clock.SleepUntil(clock.Now() - milliseconds(1));
}

TEST(SystemClock, ASignalDoesNotShortenASleep) {
  SystemClock clock;
  struct sigaction ignore {};
  struct sigaction before {};
  ignore.sa_handler = [](int) {};
  ASSERT_EQ(sigaction(SIGALRM, &ignore, &before), 0);
  const itimerval every = {.it_interval = {.tv_sec = 0, .tv_usec = 1000},
                           .it_value = {.tv_sec = 0, .tv_usec = 1000}};
  ASSERT_EQ(setitimer(ITIMER_REAL, &every, nullptr), 0);
  const Time until = clock.Now() + milliseconds(20);
  clock.SleepUntil(until);
  const Time awake = clock.Now();
  const itimerval off{};
  setitimer(ITIMER_REAL, &off, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_GE(awake, until);
}

}  // namespace
}  // namespace facewire::hal
