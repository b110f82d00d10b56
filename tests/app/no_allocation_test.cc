// The promise of the design: after start the service takes nothing from the heap and gives nothing
// back. The whole service runs here as it runs in the demo: real networks, the shipped profile and
// rig, looped footage in memory, a pseudo-terminal with somebody reading at its other end.

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <optional>

#include "app/application.h"
#include "hal/pty/pty_port.h"
#include "hal/system_clock.h"
#include "tests/app/scratch.h"
#include "tests/support/allocation_counter.h"

namespace facewire::app {
namespace {

class Context {
 public:
  Context() {
    scratch.Write("facewire.toml",
                  "[camera]\ndevice = \"replay\"\n[camera.replay]\nfile = \"" FACEWIRE_ASSETS
                  "/footage/franck.mp4\"\npace = \"fast\"\nmemory_mib = 64\nloop = \"ping-pong\"\n"
                  "[tracker]\nnetworks = \"" FACEWIRE_ASSETS
                  "/networks\"\n[character]\nrig = \"" FACEWIRE_SOURCE_DIR
                  "/app/share/otto.toml\"\nprofile = \"" FACEWIRE_SOURCE_DIR
                  "/app/share/average.profile\"\n[neutral]\nfolder = \"state\"\n"
                  "[host]\nline = \"pty:line\"\ndescribe_every_s = 1.0\n");
    application.emplace(ApplicationOptions{.config = scratch / "facewire.toml", .fake = true},
                        clock);
    application->Open();
    reader.emplace((scratch / "line").string());
    EXPECT_TRUE(reader->Open());
  }
  // Ticks; the host takes what has come.
  bool Tick() {
    const bool alive = application->service().Tick();
    while (const auto read = reader->Read(buffer, std::chrono::milliseconds(0))) bytes += *read;
    return alive;
  }

  Scratch scratch;
  hal::SystemClock clock;
  std::optional<Application> application;
  std::optional<hal::pty::PtyPort> reader;
  std::array<std::byte, 8192> buffer;
  std::size_t bytes = 0;
};

TEST(NoAllocation, TheServiceRunsWithoutTheHeapFromFrame10ToFrame1000) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c;
  test::AllocationCounter counter;
  const ServiceStats& stats = c.application->service().stats();
  while (stats.frames < 10) ASSERT_TRUE(c.Tick());
  const std::size_t before = c.bytes;
  counter.Arm();
  bool alive = true;
  while (alive && stats.frames < 1000) alive = c.Tick();
  counter.Disarm();
  counter.PrintFirst();
  EXPECT_TRUE(alive);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
  // It was the real thing.
  EXPECT_GT(stats.faces, 900U);
  EXPECT_GT(c.bytes - before, 100'000U);
  EXPECT_EQ(c.application->service().state(), ServiceState::kTracking);
}

TEST(NoAllocation, AnAllocationOnPurposeIsSeen) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c;
  test::AllocationCounter counter;
  const ServiceStats& stats = c.application->service().stats();
  while (stats.frames < 10) ASSERT_TRUE(c.Tick());
  counter.Arm();
  while (stats.frames < 15) {
    c.Tick();
    if (stats.frames == 12) {
      void* volatile on_purpose = std::malloc(1);
      std::free(on_purpose);
    }
  }
  counter.Disarm();
  EXPECT_EQ(counter.allocations(), 1U);
  EXPECT_EQ(counter.frees(), 1U);
}

}  // namespace
}  // namespace facewire::app
