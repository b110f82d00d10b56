#include "hal/libcamera/hand_over.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace facewire::hal::libcamera {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

Completion Numbered(std::uint32_t sequence) { return {.sequence = sequence}; }

TEST(HandOver, GivesWhatHasComeOldestFirstAndOnce) {
  HandOver hand_over;
  hand_over.Push(Numbered(1));
  hand_over.Push(Numbered(2));
  const Result<Completions> taken = hand_over.Take(Steady::now());
  ASSERT_TRUE(taken);
  ASSERT_EQ(taken->size(), 2U);
  EXPECT_EQ((*taken)[0].sequence, 1U);
  EXPECT_EQ((*taken)[1].sequence, 2U);
  EXPECT_EQ(hand_over.Take(Steady::now()).error(), Errc::kTimeout);
}

TEST(HandOver, HoldsAsManyAsThereAreBuffers) {
  HandOver hand_over;
  for (std::uint32_t i = 0; i < kMaxBuffers; ++i) hand_over.Push(Numbered(i));
  EXPECT_EQ(hand_over.Take(Steady::now())->size(), kMaxBuffers);
}

TEST(HandOver, WaitsUntilTheDeadlineAndNoLonger) {
  HandOver hand_over;
  const auto before = Steady::now();
  EXPECT_EQ(hand_over.Take(before + milliseconds(20)).error(), Errc::kTimeout);
  EXPECT_GE(Steady::now(), before + milliseconds(20));
}

TEST(HandOver, APictureEndsAWait) {
  HandOver hand_over;
  std::thread camera([&] { hand_over.Push(Numbered(7)); });
  const Result<Completions> taken = hand_over.Take(Steady::now() + seconds(60));
  camera.join();
  ASSERT_TRUE(taken);
  EXPECT_EQ((*taken)[0].sequence, 7U);
}

TEST(HandOver, LosingTheCameraEndsAWaitAndStaysSoUntilReset) {
  HandOver hand_over;
  hand_over.Push(Numbered(1));
  std::thread camera([&] { hand_over.Lose(); });
  camera.join();
  EXPECT_EQ(hand_over.Take(Steady::now() + seconds(60)).error(), Errc::kDisconnected);
  EXPECT_EQ(hand_over.Take(Steady::now() + seconds(60)).error(), Errc::kDisconnected);
  hand_over.Reset();
  EXPECT_EQ(hand_over.Take(Steady::now()).error(), Errc::kTimeout);
}

TEST(HandOver, LosesNothingBetweenTwoThreads) {
  HandOver hand_over;
  constexpr std::uint32_t kCount = 10'000;
  std::atomic<std::uint32_t> taken = 0;  // a camera has only so many buffers: it waits for one
  std::thread camera([&] {
    for (std::uint32_t i = 0; i < kCount; ++i) {
      while (i - taken.load() >= kMaxBuffers) std::this_thread::yield();
      hand_over.Push(Numbered(i));
    }
  });
  std::uint32_t next = 0;
  while (next < kCount) {
    const Result<Completions> some = hand_over.Take(Steady::now() + seconds(60));
    if (!some) break;
    for (const Completion& completion : *some) EXPECT_EQ(completion.sequence, next++);
    taken = next;
  }
  camera.join();
  EXPECT_EQ(next, kCount);
}

}  // namespace
}  // namespace facewire::hal::libcamera
