#ifndef FACEWIRE_TESTS_SUPPORT_ALLOCATION_COUNTER_H_
#define FACEWIRE_TESTS_SUPPORT_ALLOCATION_COUNTER_H_

#include <cstdint>

// These sanitizers bring their own malloc; replacing that one would blind them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FACEWIRE_TESTS_SANITIZER_OWNS_MALLOC 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FACEWIRE_TESTS_SANITIZER_OWNS_MALLOC 1
#endif
#endif
#ifndef FACEWIRE_TESTS_SANITIZER_OWNS_MALLOC
#define FACEWIRE_TESTS_SANITIZER_OWNS_MALLOC 0
#endif

namespace facewire::test {

// Counts what the whole process takes from the heap and gives back while armed: all threads, and
// the code in shared libraries too (XNNPACK, OpenCV, the C++ library's operator new).
//
// Linking facewire_test_support and using this class replaces malloc and its relatives in the test
// executable by versions that count and then call glibc's own. There is one heap, so there is one
// count: arm one counter at a time.
//
//   if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
//   AllocationCounter counter;
//   counter.Arm();
//   ... what must not allocate ...
//   counter.Disarm();
//   EXPECT_EQ(counter.allocations(), 0U) << "see the call stack above";
//   EXPECT_EQ(counter.frees(), 0U);
//   counter.PrintFirst();  // to stderr, when there was one
class AllocationCounter {
 public:
#if FACEWIRE_TESTS_SANITIZER_OWNS_MALLOC
  static constexpr bool kAvailable = false;
#else
  static constexpr bool kAvailable = true;
#endif
  static constexpr const char* kWhyNot =
      "the sanitizer owns malloc, so allocations are not counted";

  AllocationCounter() noexcept = default;
  ~AllocationCounter() { Disarm(); }
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  // Sets both counts to zero and starts to count.
  void Arm() noexcept;
  // Stops; the counts stay until the next Arm. Harmless when not armed.
  void Disarm() noexcept;

  // Calls of malloc, calloc, realloc, memalign, aligned_alloc, posix_memalign and, through them,
  // new.
  std::uint64_t allocations() const noexcept;
  // Calls of free with something to free, and of realloc with something to move.
  std::uint64_t frees() const noexcept;

  // Writes the call stack of the first allocation or free since Arm to stderr; nothing if there was
  // none.
  void PrintFirst() const noexcept;
};

}  // namespace facewire::test

#endif  // FACEWIRE_TESTS_SUPPORT_ALLOCATION_COUNTER_H_
