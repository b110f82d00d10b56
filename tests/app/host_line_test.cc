#include "app/host_line.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "core/wire/rig_description.h"
#include "hal/fake/fake_clock.h"
#include "hal/fake/fake_serial_port.h"
#include "hal/pty/pty_host.h"
#include "hal/pty/pty_port.h"
#include "hal/system_clock.h"
#include "tests/app/service_context.h"
#include "tests/hal/far_end.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kBudget{5};

// The line of a small rig, and the host that reads what it takes.
struct Link {
  Link() { line.SetRig(rig, wire::RigId(rig)); }
  bool Send() {
    ++seq;
    RigPose values = rig.NeutralPose();
    values.seq = seq;
    const wire::Pose pose =
        wire::MakePose(rig, wire::RigId(rig), values, ServiceState::kTracking, clock.Now());
    const bool sent = line.Send(pose, nullptr);
    clock.Advance(milliseconds(33));
    Receive();
    return sent;
  }
  void Receive() {
    const auto& written = port.written();
    for (; read < written.total(); ++read) {
      const std::byte byte = written[read - (written.total() - written.size())];
      std::span<const std::byte> rest(&byte, 1);
      while (!rest.empty()) {
        const auto got = decoder.Next(rest);
        if (!got) break;
        if (const auto* pose = std::get_if<wire::Pose>(&got->message)) {
          received.push_back(pose->frame_seq);
        }
        host_rig.Add(got->message);
      }
    }
  }

  Rig rig = SmallRig();
  hal::fake::FakeClock clock{Time{seconds(1000)}};
  hal::fake::FakeSerialPort port{clock};
  HostLine line{&port, clock, kBudget};
  std::uint32_t seq = 0;
  std::uint64_t read = 0;
  wire::Decoder decoder;
  std::vector<std::uint32_t> received;
  wire::RigCollector host_rig;
};

TEST(HostLine, AHostThatAsksAgainWithEveryPoseGetsTheWholeRig) {
  Link link;
  ASSERT_TRUE(link.line.Open());
  for (int i = 0; i < 3; ++i) {
    link.line.Describe();
    link.Send();
  }
  EXPECT_TRUE(link.host_rig.Complete());
}

TEST(HostLine, GoesOnAtTheRightByteWhereverALineThatWasFullCutIt) {
  Link sizes;
  ASSERT_TRUE(sizes.line.Open());
  for (int i = 0; i < 3; ++i) sizes.Send();
  const auto most = static_cast<std::size_t>(sizes.port.written().total());
  for (std::size_t cut = 0; cut <= most; ++cut) {
    Link link;
    ASSERT_TRUE(link.line.Open());
    link.port.AcceptOnly(cut);
    for (int i = 0; i < 6; ++i) link.Send();
    link.port.AcceptAll();
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(link.Send()) << cut;
    EXPECT_EQ(link.decoder.stats().Damaged(), 0U) << cut;
    EXPECT_EQ(link.received.back(), 9U) << cut;
    EXPECT_TRUE(std::ranges::is_sorted(link.received)) << cut;
    EXPECT_EQ(link.line.counters().poses + link.line.counters().poses_dropped, 9U) << cut;
    EXPECT_EQ(link.line.counters().bytes, link.port.written().total()) << cut;
  }
}

TEST(HostLine, APlugThatIsPulledInAFrameCostsThatFrameAlone) {
  Link sizes;
  ASSERT_TRUE(sizes.line.Open());
  sizes.Send();
  const auto most = static_cast<std::size_t>(sizes.port.written().total());
  for (std::size_t cut = 1; cut < most; ++cut) {
    Link link;
    ASSERT_TRUE(link.line.Open());
    link.port.AcceptOnly(cut);
    link.Send();
    link.port.Unplug();
    link.Send();
    link.port.AcceptAll();
    link.port.Plug();
    link.clock.Advance(seconds(1));
    EXPECT_TRUE(link.Send()) << cut;
    EXPECT_EQ(link.received.back(), 3U) << cut;
    EXPECT_LE(link.decoder.stats().Damaged(), 1U) << cut;
    EXPECT_EQ(link.line.counters().hang_ups, 1U);
    EXPECT_EQ(link.line.counters().opens, 2U);
  }
}

TEST(HostLine, OpensALineThatIsGoneEverMoreRarelyAndFindsItWhenItIsBack) {
  Link link;
  ASSERT_TRUE(link.line.Open());
  link.port.Unplug();
  for (int i = 0; i < 30 * 60; ++i) link.Send();  // a minute
  int tries = 0;
  for (std::size_t i = 0; i < link.port.events().size(); ++i) {
    tries += link.port.events()[i].kind == hal::fake::SerialEventKind::kOpenFailed ? 1 : 0;
  }
  EXPECT_GE(tries, 8);
  EXPECT_LE(tries, 14);
  EXPECT_FALSE(link.line.connected());
  link.port.Plug();
  for (int i = 0; i < 30 * 8; ++i) link.Send();
  EXPECT_TRUE(link.line.connected());
  EXPECT_EQ(link.received.back(), link.seq);
}

TEST(HostLine, ATickNeverWaitsLongerThanItsBudget) {
  Link link;
  ASSERT_TRUE(link.line.Open());
  link.Send();
  for (const std::size_t room : {0U, 1U, 10U, 200U}) {
    link.port.AcceptOnly(room);
    for (int i = 0; i < 20; ++i) {
      const Time before = link.clock.Now();
      link.Send();
      EXPECT_LE(link.clock.Now() - before, milliseconds(33) + kBudget) << room;
    }
    link.port.AcceptAll();
    link.Send();
  }
}

// The real thing: a terminal whose buffer fills up because the host reads in fits and starts.
TEST(HostLine, AHostThatReadsNowAndThenSeesWholeFramesOnly) {
  const hal::test::TemporaryFolder folder;
  hal::SystemClock clock;
  hal::pty::PtyHost port(folder.File("line"));
  HostLine line(&port, clock, milliseconds(0));
  const Rig rig = SmallRig();
  line.SetRig(rig, wire::RigId(rig));
  ASSERT_TRUE(line.Open());
  hal::pty::PtyPort host(folder.File("line"));
  ASSERT_TRUE(host.Open());
  wire::Decoder decoder;
  std::vector<std::byte> buffer(777);
  std::vector<std::uint32_t> received;
  const auto read = [&](std::chrono::milliseconds timeout) {
    const auto count = host.Read(buffer, timeout);
    if (!count) return false;
    std::span<const std::byte> rest = std::span(buffer).first(*count);
    while (!rest.empty()) {
      const auto got = decoder.Next(rest);
      if (!got) continue;
      if (const auto* pose = std::get_if<wire::Pose>(&got->message)) {
        received.push_back(pose->frame_seq);
      }
    }
    return true;
  };
  for (std::uint32_t seq = 1; seq <= 2000; ++seq) {
    RigPose values = rig.NeutralPose();
    values.seq = seq;
    (void)line.Send(
        wire::MakePose(rig, wire::RigId(rig), values, ServiceState::kTracking, clock.Now()),
        nullptr);
    if (seq % 250 == 0) {
      for (int i = 0; i < 3; ++i) (void)read(milliseconds(0));  // not enough to empty it
    }
  }
  EXPECT_GT(line.counters().poses_dropped, 100U) << "the buffer was full";
  while (read(milliseconds(50))) {
  }
  RigPose last = rig.NeutralPose();
  last.seq = 2001;
  EXPECT_TRUE(line.Send(
      wire::MakePose(rig, wire::RigId(rig), last, ServiceState::kTracking, clock.Now()), nullptr));
  while (read(milliseconds(200))) {
  }
  EXPECT_EQ(decoder.stats().Damaged(), 0U);
  EXPECT_EQ(received.back(), 2001U);
  EXPECT_EQ(received.size(), line.counters().poses) << "what counts as sent has arrived";
}

}  // namespace
}  // namespace facewire::app
