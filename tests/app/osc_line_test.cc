#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/host_line.h"
#include "core/wire/osc/osc.h"
#include "core/wire/osc/reader.h"
#include "core/wire/osc/slip.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "hal/fake/fake_clock.h"
#include "hal/fake/fake_serial_port.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// A line that speaks OSC, and the host that reads what it takes.
struct OscLink {
  explicit OscLink(int baud = 115200)
      : line(&port, clock, milliseconds(5), HostProtocol::kOsc, baud) {
    line.SetRig(rig, wire::RigId(rig));
    EXPECT_TRUE(line.Open());
  }
  bool Send(const wire::Status* status = nullptr) {
    ++seq;
    values.seq = seq;
    const bool sent = line.Send(
        wire::MakePose(rig, wire::RigId(rig), values, ServiceState::kTracking, clock.Now()),
        status);
    clock.Advance(milliseconds(33));
    Receive();
    return sent;
  }
  void Receive() {
    const auto& written = port.written();
    for (; read < written.total(); ++read) {
      const std::byte byte = written[read - (written.total() - written.size())];
      std::span<const std::byte> rest(&byte, 1);
      const auto packet = slip.Next(rest);
      if (!packet) {
        damaged += packet.error() == Errc::kNotReady ? 0 : 1;
        continue;
      }
      auto reader = wire::osc::Reader::Of(*packet);
      damaged += reader ? 0 : 1;
      if (!reader) continue;
      while (const auto message = reader->Next()) {
        const std::string address(message->address);
        ++count[address];
        if (address == "/facewire/pose") {
          poses.push_back(static_cast<std::uint32_t>(*message->Number()));
        } else if (address.starts_with("/face/")) {
          received[address] = *message->Number();
        } else {
          last[address].assign(reinterpret_cast<const char*>(message->arguments.data()),
                               message->arguments.size());
        }
      }
    }
  }
  template <class... Args>
  void Say(std::string_view address, const Args&... args) {
    std::array<std::byte, 64> buffer{};
    wire::osc::Writer packet(buffer);
    ASSERT_TRUE(packet.Message(address, args...));
    std::array<std::byte, wire::osc::MaxSlipBytes(64)> frame{};
    ASSERT_TRUE(port.Feed(*wire::osc::Slip(packet.bytes(), frame)));
  }

  Rig rig = SmallRig();
  RigPose values = rig.NeutralPose();
  hal::fake::FakeClock clock{Time{seconds(1000)}};
  hal::fake::FakeSerialPort port{clock};
  HostLine line;
  std::uint32_t seq = 0;
  std::uint64_t read = 0;
  std::array<std::byte, wire::osc_host::kMaxPacketBytes> memory{};
  wire::osc::SlipDecoder slip{memory};
  std::vector<std::uint32_t> poses;
  std::map<std::string, float> received;
  std::map<std::string, int> count;
  std::map<std::string, std::string> last;  // arguments
  int damaged = 0;
};

TEST(OscLine, CarriesPosesAndTheRigAndTheStatus) {
  OscLink link;
  const wire::Status status{.state = ServiceState::kTracking};
  for (int i = 0; i < 10; ++i) link.Send(&status);
  EXPECT_EQ(link.damaged, 0);
  EXPECT_EQ(link.poses.size(), 10U);
  EXPECT_EQ(link.received.size(), link.rig.channels.size());
  EXPECT_EQ(link.count["/facewire/rig"], 1);
  EXPECT_EQ(link.count["/facewire/bone"], static_cast<int>(link.rig.bones.size()));
  EXPECT_EQ(link.count["/facewire/channel"], static_cast<int>(link.rig.channels.size()));
  EXPECT_EQ(link.count["/facewire/status"], 10);
}

TEST(OscLine, ObeysAndAnswers) {
  OscLink link;
  link.Say("/facewire/release", std::int32_t{1});
  link.Say("/facewire/stop");
  const auto release = link.line.NextCommand();
  ASSERT_TRUE(release);
  EXPECT_EQ(release->code, wire::CommandCode::kRelease);
  const auto stop = link.line.NextCommand();
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->code, wire::CommandCode::kStop);
  EXPECT_FALSE(link.line.NextCommand());
  link.line.Acknowledge({.code = stop->code, .result = wire::CommandResult::kOk});
  link.Send();
  EXPECT_TRUE(link.last["/facewire/answer"].starts_with("stop"));
  EXPECT_EQ(link.line.received().frames, 2U);
}

TEST(OscLine, GoesOnAtTheRightByteWhereverALineThatWasFullCutIt) {
  OscLink sizes;
  for (int i = 0; i < 3; ++i) sizes.Send();
  const auto most = static_cast<std::size_t>(sizes.port.written().total());
  for (std::size_t cut = 0; cut <= most; ++cut) {
    OscLink link;
    link.port.AcceptOnly(cut);
    for (int i = 0; i < 6; ++i) link.Send();
    link.port.AcceptAll();
    link.values.values[0] = link.rig.channels[0].max;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(link.Send()) << cut;
    EXPECT_EQ(link.damaged, 0) << cut;
    EXPECT_EQ(link.poses.back(), 9U) << cut;
    EXPECT_EQ(link.received.size(), link.rig.channels.size()) << cut;
    EXPECT_EQ(link.received["/face/jaw/pitch"], link.rig.channels[0].max) << cut;
    // One that was finished in a later tick counts as dropped.
    EXPECT_GE(link.poses.size(), link.line.counters().poses) << cut;
    EXPECT_EQ(link.line.counters().poses + link.line.counters().poses_dropped, 9U) << cut;
  }
}

TEST(OscLine, AReceiverBehindAPlugThatWasPulledGetsEveryValueAgain) {
  OscLink link;
  for (int i = 0; i < 5; ++i) link.Send();
  link.port.Unplug();
  link.Send();
  link.port.Plug();
  link.received.clear();
  link.clock.Advance(seconds(1));
  EXPECT_TRUE(link.Send());
  EXPECT_EQ(link.received.size(), link.rig.channels.size());
}

TEST(OscLine, SaysNoMoreThanTheLineCarries) {
  for (const int baud : {9600, 38400, 115200}) {
    OscLink link(baud);
    for (int i = 0; i < 10; ++i) link.Send();
    const std::uint64_t before = link.port.written().total();
    const std::uint64_t poses_before = link.poses.size();
    for (int i = 0; i < 300; ++i) {  // 9.9 s
      for (std::size_t k = 0; k < link.rig.channels.size(); ++k) {
        link.values.values[k] = i % 2 == 0 ? link.rig.channels[k].min : link.rig.channels[k].max;
      }
      if (i % 150 == 0) link.line.Describe();
      link.Send();
    }
    EXPECT_LT(static_cast<double>(link.port.written().total() - before), 9.9 * baud / 10) << baud;
    EXPECT_GT(link.poses.size() - poses_before, 50U) << "and poses keep coming";
    EXPECT_EQ(link.damaged, 0);
  }
}

}  // namespace
}  // namespace facewire::app
