#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <thread>

namespace facewire::test {
namespace {

class AllocationCounterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  }
  AllocationCounter counter_;
};

// Keeps the compiler from dropping an allocation that nobody uses.
void Use(void* block) { asm volatile("" : : "g"(block) : "memory"); }

TEST_F(AllocationCounterTest, SeesNothingWhereNothingIsAllocated) {
  counter_.Arm();
  counter_.Disarm();
  EXPECT_EQ(counter_.allocations(), 0U);
  EXPECT_EQ(counter_.frees(), 0U);
}

TEST_F(AllocationCounterTest, CountsEveryWayToTheHeap) {
  counter_.Arm();
  void* a = std::malloc(10);
  Use(a);
  void* b = std::calloc(2, 10);
  Use(b);
  void* c = std::realloc(nullptr, 10);
  Use(c);
  void* d = std::aligned_alloc(64, 64);
  Use(d);
  void* e = nullptr;
  const int result = posix_memalign(&e, 64, 10);
  Use(e);
  int* f = new int(1);
  Use(f);
  std::free(a);
  std::free(b);
  std::free(c);
  std::free(d);
  std::free(e);
  delete f;
  counter_.Disarm();
  EXPECT_EQ(result, 0);
  EXPECT_EQ(counter_.allocations(), 6U);
  EXPECT_EQ(counter_.frees(), 6U);
}

TEST_F(AllocationCounterTest, AMovingReallocIsAnAllocationAndAFree) {
  void* block = std::malloc(10);
  Use(block);
  counter_.Arm();
  block = std::realloc(block, 100000);
  Use(block);
  counter_.Disarm();
  EXPECT_EQ(counter_.allocations(), 1U);
  EXPECT_EQ(counter_.frees(), 1U);
  std::free(block);
}

TEST_F(AllocationCounterTest, FreeingNothingIsNotAFree) {
  counter_.Arm();
  std::free(nullptr);
  counter_.Disarm();
  EXPECT_EQ(counter_.frees(), 0U);
}

TEST_F(AllocationCounterTest, SeesCodeInSharedLibraries) {
  const std::string text = "a string that is too long to be held in place";
  counter_.Arm();
  char* copy = strdup(text.c_str());  // libc
  std::string longer = text;          // libstdc++
  longer.append(text);
  counter_.Disarm();
  EXPECT_GE(counter_.allocations(), 3U);
  std::free(copy);
}

TEST_F(AllocationCounterTest, SeesOtherThreads) {
  counter_.Arm();
  std::thread([] { Use(std::make_unique<int>(1).get()); }).join();
  counter_.Disarm();
  EXPECT_GE(counter_.allocations(), 1U);
  EXPECT_GE(counter_.frees(), 1U);
}

TEST_F(AllocationCounterTest, CountsNothingBeforeArmAndAfterDisarmAndArmStartsAgain) {
  Use(std::make_unique<int>(1).get());
  counter_.Arm();
  Use(std::make_unique<int>(1).get());
  counter_.Disarm();
  Use(std::make_unique<int>(1).get());
  EXPECT_EQ(counter_.allocations(), 1U);
  counter_.Arm();
  counter_.Disarm();
  EXPECT_EQ(counter_.allocations(), 0U);
}

TEST_F(AllocationCounterTest, AnOddAlignmentIsRefusedAsTheStandardSays) {
  void* block = nullptr;
  EXPECT_EQ(posix_memalign(&block, 24, 10), EINVAL);
  EXPECT_EQ(posix_memalign(&block, 0, 10), EINVAL);
}

TEST_F(AllocationCounterTest, NamesTheCallerOfTheFirstAllocation) {
  counter_.Arm();
  Use(std::make_unique<int>(1).get());
  counter_.Disarm();
  testing::internal::CaptureStderr();
  counter_.PrintFirst();
  EXPECT_NE(testing::internal::GetCapturedStderr().find("support_test"), std::string::npos);
}

}  // namespace
}  // namespace facewire::test
