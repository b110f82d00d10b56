// The promise of the design: after start the service takes nothing from the heap and gives nothing
// back. The whole service runs here as it runs in the demo: real networks, the shipped profile and
// rig with servos on two buses, looped footage in memory, a pseudo-terminal with somebody reading
// at its other end, the board's (mock) lines, and programs that come and go at the control socket.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "app/application.h"
#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "hal/local/local_port.h"
#include "hal/pty/pty_port.h"
#include "hal/system_clock.h"
#include "tests/app/scratch.h"
#include "tests/support/allocation_counter.h"

namespace facewire::app {
namespace {

class Context {
 public:
  // `pace`: "real-time", as the demo, or "fast", which has no pauses between the pictures.
  explicit Context(const std::string& pace) {
    scratch.Write(
        "facewire.toml",
        "[camera]\ndevice = \"replay\"\n[camera.replay]\nfile = \"" FACEWIRE_ASSETS
        "/footage/franck.mp4\"\npace = \"" +
            pace +
            "\"\nmemory_mib = 64\nloop = \"ping-pong\"\n"
            "[tracker]\nnetworks = \"" FACEWIRE_ASSETS
            "/networks\"\n[character]\nrig = \"rig.toml\"\nprofile = \"" FACEWIRE_SOURCE_DIR
            "/app/share/average.profile\"\n[neutral]\nfolder = \"state\"\n"
            "[host]\nline = \"pty:line\"\ndescribe_every_s = 1.0\n"
            "[control]\nsocket = \"control\"\n"
            "[gpio]\nstop_line = \"stop\"\ncalibrate_line = \"button\"\n"
            "status_led_line = \"led\"\nservo_power_line = \"power\"\n"
            // A controller that never answers, so that its servos move; and servos that
            // are looked for all the time.
            "[[bus]]\nname = \"pulses\"\nkind = \"maestro\"\nport = \"pty:pulses\"\n"
            "answers = false\n"
            "[[bus]]\nname = \"chain\"\nkind = \"feetech\"\nport = \"pty:chain\"\n");
    std::string rig = Scratch::Read(FACEWIRE_SOURCE_DIR "/app/share/otto.toml");
    for (const char* bus : {"pulses", "chain"}) {
      rig += std::string("[[servo]]\nname = \"jaw-") + bus + "\"\nbus = \"" + bus +
             "\"\nid = 1\nfrom = { \"jaw.pitch\" = 1 }\nmap = [[0, 1000], [24, 2000]]\n"
             "max_speed = 4000\n";
    }
    scratch.Write("rig.toml", rig);
    application.emplace(ApplicationOptions{.config = scratch / "facewire.toml", .fake = true},
                        clock, journal);
    application->Open();
    reader.emplace((scratch / "line").string());
    EXPECT_TRUE(reader->Open());
    operator_line.emplace((scratch / "control").string());
  }
  // Ticks; the host takes what has come.
  bool Tick() {
    const bool alive = application->service().Tick();
    while (const auto read = reader->Read(buffer, std::chrono::milliseconds(0))) bytes += *read;
    return alive;
  }
  // The host wants the landmarks of every picture.
  void AskLandmarks() {
    std::array<std::byte, wire::kCommandFrameBytes> out;
    const auto asked =
        host_encoder.Encode(wire::Command{.code = wire::CommandCode::kLandmarks, .value = 60}, out);
    ASSERT_TRUE(asked);
    EXPECT_TRUE(reader->Write(*asked, std::chrono::milliseconds(0)));
  }
  // A program on the board comes, commands, talks nonsense, hears the answers, and goes.
  void Command(std::uint64_t frame) {
    std::array<std::byte, wire::kCommandFrameBytes> out;
    switch (frame % 8) {
      case 0:
        EXPECT_TRUE(operator_line->Open());
        break;
      case 1:
      case 2:
      case 3: {
        constexpr wire::CommandCode kCodes[] = {wire::CommandCode::kPing,
                                                wire::CommandCode::kDescribeRig,
                                                wire::CommandCode::kBlendProfile};
        const auto sent =
            encoder.Encode(wire::Command{.code = kCodes[frame % 8 - 1], .value = 0.5F}, out);
        ASSERT_TRUE(sent);
        EXPECT_TRUE(operator_line->Write(*sent, std::chrono::milliseconds(0)));
        break;
      }
      case 4:
        (void)operator_line->Write(std::span(buffer).first(frame % 16 == 4 ? 100 : 1000),
                                   std::chrono::milliseconds(0));
        break;
      case 6:
        while (const auto read = operator_line->Read(buffer, std::chrono::milliseconds(0))) {
          answered += *read;
        }
        break;
      case 7:
        operator_line->Close();
        break;
      default:
        break;
    }
  }

  Scratch scratch;
  hal::SystemClock clock;
  Journal journal;
  std::optional<Application> application;
  std::optional<hal::pty::PtyPort> reader;
  std::optional<hal::local::LocalPort> operator_line;
  wire::Encoder encoder;
  wire::Encoder host_encoder;
  std::array<std::byte, 8192> buffer;
  std::size_t bytes = 0;
  std::size_t answered = 0;
};

TEST(NoAllocation, TheServiceRunsWithoutTheHeapFromFrame10ToFrame1000) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c("fast");
  test::AllocationCounter counter;
  const ServiceStats& stats = c.application->service().stats();
  while (stats.frames < 10) ASSERT_TRUE(c.Tick());
  const std::size_t before = c.bytes;
  counter.Arm();
  bool alive = true;
  for (std::uint64_t tick = 0; alive && stats.frames < 1000; ++tick) {
    c.Command(tick);
    if (tick % 32 == 0) c.AskLandmarks();
    alive = c.Tick();
  }
  counter.Disarm();
  counter.PrintFirst();
  EXPECT_TRUE(alive);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
  // It was the real thing.
  EXPECT_GT(stats.faces, 900U);
  // Poses are 200 KB; the rest is landmarks, of up to 60 pictures a second of 2.4 KB each.
  EXPECT_GT(c.bytes - before, 250'000U);
  EXPECT_GT(stats.commands, 300U);
  EXPECT_GT(c.answered, 5000U);
  const ServoReport* servos = c.application->service().servos();
  ASSERT_NE(servos, nullptr);
  EXPECT_GT(servos->ticks, 100U);
  EXPECT_EQ(servos->servos[0].command.activity, servo::Activity::kFollowing);
  EXPECT_EQ(c.application->service().state(), ServiceState::kTracking);
}

// The program's own loop, with its log and its notes to a supervisor, at the pace of a camera:
// ticks wait for pictures. The host arms and ends, by the frames that it hears of.
TEST(NoAllocation, TheWholeProcessRunsWithoutTheHeapInRealTimeToo) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c("real-time");
  test::AllocationCounter counter;
  Requests requests;
  std::uint32_t last = 0;
  std::jthread host([&](const std::stop_token& stop) {
    wire::Decoder decoder;
    bool armed = false;
    while (!stop.stop_requested()) {
      const auto read = c.reader->Read(c.buffer, std::chrono::milliseconds(100));
      if (!read || requests.quit.load() > 0) continue;
      std::span<const std::byte> rest = std::span(c.buffer).first(*read);
      while (!rest.empty()) {
        const auto got = decoder.Next(rest);
        const auto* pose = got ? std::get_if<wire::Pose>(&got->message) : nullptr;
        if (pose != nullptr) last = pose->frame_seq;
      }
      if (!armed && last >= 10) {
        counter.Arm();
        armed = true;
      }
      if (last < 1000) continue;
      counter.Disarm();
      requests.quit = 1;
    }
  });
  c.application->Run(requests, Duration::zero());
  host.request_stop();
  host.join();
  counter.PrintFirst();
  EXPECT_GE(last, 1000U);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
  EXPECT_GT(c.application->Report().faces, 900U);
}

TEST(NoAllocation, AnAllocationOnPurposeIsSeen) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Context c("fast");
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
