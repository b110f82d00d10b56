#include "app/animatronic/latest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <thread>

namespace facewire::app {
namespace {

TEST(Latest, IsEmptyBeforeTheFirstValue) {
  Latest<int> latest;
  EXPECT_EQ(latest.Take(), nullptr);
}

TEST(Latest, GivesEachValueOnceAndOnlyTheNewest) {
  Latest<int> latest;
  latest.Put(1);
  latest.Put(2);
  latest.Put(3);
  const int* taken = latest.Take();
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(*taken, 3);
  EXPECT_EQ(latest.Take(), nullptr);
  latest.Put(4);
  latest.Put(5);
  EXPECT_EQ(*taken, 3) << "stays until the next call";
  taken = latest.Take();
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(*taken, 5);
}

// A value that is torn, or older than the one before, would be seen in its words.
TEST(Latest, IsWholeAndNeverGoesBackWhateverTheOtherThreadDoes) {
  using Words = std::array<std::uint64_t, 64>;
  constexpr std::uint64_t kLast = 200'000;
  Latest<Words> latest;
  std::thread writer([&] {
    Words words;
    for (std::uint64_t n = 1; n <= kLast; ++n) {
      words.fill(n);
      latest.Put(words);
    }
  });
  std::uint64_t last = 0;
  while (last < kLast) {
    const Words* words = latest.Take();
    if (words == nullptr) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_TRUE(std::ranges::all_of(*words, [&](auto word) { return word == words->front(); }));
    ASSERT_GT(words->front(), last);
    last = words->front();
  }
  writer.join();
  EXPECT_EQ(last, kLast) << "the last one always arrives";
}

}  // namespace
}  // namespace facewire::app
