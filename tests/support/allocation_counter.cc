#include "tests/support/allocation_counter.h"

#include <execinfo.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>

namespace facewire::test {
namespace {

constexpr int kMaxStackFrames = 32;

// Constant-initialised: malloc is called long before any constructor runs.
struct Counts {
  std::atomic<bool> armed{false};
  std::atomic<std::uint64_t> allocations{0};
  std::atomic<std::uint64_t> frees{0};
  std::atomic<bool> first_taken{false};
  std::atomic<int> first_frames{0};
  std::array<void*, kMaxStackFrames> first_stack{};
};
constinit Counts g_counts;

}  // namespace

void AllocationCounter::Arm() noexcept {
  // The first backtrace of a process loads the unwinder, which allocates: have that over with.
  std::array<void*, 1> unused{};
  backtrace(unused.data(), static_cast<int>(unused.size()));
  g_counts.armed = false;
  g_counts.allocations = 0;
  g_counts.frees = 0;
  g_counts.first_frames = 0;
  g_counts.first_taken = false;
  g_counts.armed = true;
}

void AllocationCounter::Disarm() noexcept { g_counts.armed = false; }

std::uint64_t AllocationCounter::allocations() const noexcept { return g_counts.allocations; }

std::uint64_t AllocationCounter::frees() const noexcept { return g_counts.frees; }

void AllocationCounter::PrintFirst() const noexcept {
  backtrace_symbols_fd(g_counts.first_stack.data(), g_counts.first_frames, STDERR_FILENO);
}

}  // namespace facewire::test

#if !FACEWIRE_TESTS_SANITIZER_OWNS_MALLOC

namespace {

using facewire::test::g_counts;

void Count(std::atomic<std::uint64_t>& count) noexcept {
  if (!g_counts.armed.load(std::memory_order_relaxed)) return;
  count.fetch_add(1, std::memory_order_relaxed);
  // Set before the backtrace, which may itself come here: then this is not the first any more.
  if (g_counts.first_taken.exchange(true)) return;
  g_counts.first_frames =
      backtrace(g_counts.first_stack.data(), static_cast<int>(g_counts.first_stack.size()));
}

}  // namespace

// glibc's own functions under the names that it exports for exactly this purpose.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the names are glibc's.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  Count(g_counts.allocations);
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  Count(g_counts.allocations);
  return __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) {
  Count(g_counts.allocations);
  if (old != nullptr) Count(g_counts.frees);
  return __libc_realloc(old, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  Count(g_counts.allocations);
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  Count(g_counts.allocations);
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) {
    return EINVAL;
  }
  Count(g_counts.allocations);
  void* block = __libc_memalign(alignment, size);
  if (block == nullptr) return ENOMEM;
  *out = block;
  return 0;
}

void free(void* block) {
  if (block == nullptr) return;
  Count(g_counts.frees);
  __libc_free(block);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}  // extern "C"

#endif
