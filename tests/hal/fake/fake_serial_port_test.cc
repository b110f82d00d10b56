#include "hal/fake/fake_serial_port.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "hal/fake/fake_clock.h"
#include "tests/hal/serial_port_conformance.h"

namespace facewire::hal::fake {
namespace {

using std::chrono::milliseconds;
using test::Bytes;

class FakeLine {
 public:
  static const char* WhyUnavailable() { return nullptr; }
  SerialPort& port() { return port_; }
  Clock& clock() { return clock_; }
  void FarSend(std::span<const std::byte> bytes) {
    if (!port_.Feed(bytes)) throw std::runtime_error("the feed is full");
  }
  std::vector<std::byte> FarReceive(std::size_t count) {
    std::vector<std::byte> bytes;
    const auto& written = port_.written();
    while (bytes.size() < count && seen_ < written.total()) {
      bytes.push_back(written[seen_++ - (written.total() - written.size())]);
    }
    return bytes;
  }
  void Unplug() { port_.Unplug(); }
  void Plug() { port_.Plug(); }
  void Stall() { port_.AcceptOnly(1000); }
  void Resume() { port_.AcceptAll(); }

 private:
  FakeClock clock_;
  FakeSerialPort port_{clock_};
  std::uint64_t seen_ = 0;
};

}  // namespace
}  // namespace facewire::hal::fake

namespace facewire::hal::test {
INSTANTIATE_TYPED_TEST_SUITE_P(Fake, SerialPortConformance, fake::FakeLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Fake, SerialPortHangUp, fake::FakeLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Fake, SerialPortStall, fake::FakeLine);
// A fake is a line of its own: there is no second port of it.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SerialPortExclusive);
}  // namespace facewire::hal::test

namespace facewire::hal::fake {
namespace {

TEST(FakeSerialPort, RemembersWhatHappenedAndWhen) {
  FakeClock clock(Time{milliseconds(100)});
  FakeSerialPort port(clock);
  ASSERT_TRUE(port.Open());
  clock.Advance(milliseconds(5));
  ASSERT_EQ(port.Write(Bytes(7), milliseconds(1)), 7U);
  port.Unplug();
  ASSERT_EQ(port.events().size(), 3U);
  EXPECT_EQ(port.events()[0].kind, SerialEventKind::kOpened);
  EXPECT_EQ(port.events()[1].kind, SerialEventKind::kWritten);
  EXPECT_EQ(port.events()[1].bytes, 7U);
  EXPECT_EQ(port.events()[1].at, Time{milliseconds(105)});
  EXPECT_EQ(port.events()[2].kind, SerialEventKind::kUnplugged);
}

TEST(FakeSerialPort, KeepsTheLastBytesAndCountsAll) {
  FakeClock clock;
  FakeSerialPort port(clock);
  ASSERT_TRUE(port.Open());
  const auto block = Bytes(FakeSerialPort::kWrittenCapacity);
  ASSERT_TRUE(port.Write(block, milliseconds(1)));
  ASSERT_TRUE(port.Write(Bytes(1, 0xAB), milliseconds(1)));
  EXPECT_EQ(port.written().total(), FakeSerialPort::kWrittenCapacity + 1);
  EXPECT_EQ(port.written().size(), FakeSerialPort::kWrittenCapacity);
  EXPECT_EQ(port.written()[0], block[1]);
  EXPECT_EQ(port.written()[port.written().size() - 1], std::byte{0xAB});
}

TEST(FakeSerialPort, FedBytesArriveAtTheirTime) {
  FakeClock clock;
  FakeSerialPort port(clock);
  ASSERT_TRUE(port.Open());
  ASSERT_TRUE(port.Feed(Bytes(2, 10), Time{milliseconds(50)}));
  ASSERT_TRUE(port.Feed(Bytes(2, 20), Time{milliseconds(80)}));
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(port.Read(buffer, milliseconds(40)).error(), Errc::kTimeout);
  EXPECT_EQ(clock.Now(), Time{milliseconds(40)});
  EXPECT_EQ(port.Read(buffer, milliseconds(40)), 2U);
  EXPECT_EQ(clock.Now(), Time{milliseconds(50)});
  EXPECT_EQ(buffer[0], std::byte{10});
  clock.Advance(milliseconds(100));
  EXPECT_EQ(port.Read(std::span(buffer).first(1), milliseconds(0)), 1U);
  EXPECT_EQ(port.Read(buffer, milliseconds(0)), 1U);
  EXPECT_EQ(buffer[0], std::byte{21});
}

TEST(FakeSerialPort, AFeedThatDoesNotFitIsRefusedWhole) {
  FakeClock clock;
  FakeSerialPort port(clock);
  ASSERT_TRUE(port.Open());
  ASSERT_TRUE(port.Feed(Bytes(FakeSerialPort::kIncomingCapacity)));
  EXPECT_FALSE(port.Feed(Bytes(1)));
  EXPECT_EQ(test::ReadAll(port, FakeSerialPort::kIncomingCapacity).size(),
            FakeSerialPort::kIncomingCapacity);
  EXPECT_TRUE(port.Feed(Bytes(1)));
}

TEST(FakeSerialPort, OpenFailsAsOftenAsTold) {
  FakeClock clock;
  FakeSerialPort port(clock);
  port.FailOpens(2, Errc::kBusy);
  EXPECT_EQ(port.Open().error(), Errc::kBusy);
  EXPECT_EQ(port.Open().error(), Errc::kBusy);
  EXPECT_TRUE(port.Open());
}

}  // namespace
}  // namespace facewire::hal::fake
