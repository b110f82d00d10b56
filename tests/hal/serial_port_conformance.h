#ifndef FACEWIRE_TESTS_HAL_SERIAL_PORT_CONFORMANCE_H_
#define FACEWIRE_TESTS_HAL_SERIAL_PORT_CONFORMANCE_H_

#include <gtest/gtest.h>
#include <sys/time.h>

#include <chrono>
#include <csignal>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "hal/serial_port.h"
#include "tests/support/allocation_counter.h"

// What every backend of hal::SerialPort must do. A backend brings a Line: a port with a far end
// that the test holds, freshly made for every test and not yet open.
//
//   struct Line {
//     static const char* WhyUnavailable();           // nullptr, or why this machine cannot run it
//     SerialPort& port();
//     Clock& clock();                                // the time in which the port waits
//     void FarSend(std::span<const std::byte>);      // the far end says something
//     std::vector<std::byte> FarReceive(std::size_t count);  // what came there: waits for `count`
//     bytes,
//   };                                               // a few seconds at most
//
// and instantiates SerialPortConformance. It adds, where the line has such a thing:
//   SerialPortHangUp     void Unplug(), void Plug()  // the device goes and comes back
//   SerialPortStall      void Stall(), void Resume() // the far end stops taking bytes
//   SerialPortExclusive  std::unique_ptr<SerialPort> SecondPort()  // of the same line
namespace facewire::hal::test {

using std::chrono::milliseconds;

inline constexpr milliseconds kAmple{5000};  // of a wait that ends early when all is well
inline constexpr milliseconds kBrief{30};    // of a wait that is meant to end at its deadline

inline std::vector<std::byte> Bytes(std::size_t count, unsigned first = 0) {
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>((first + i) & 0xFFU);
  return bytes;
}

inline std::vector<std::byte> ReadAll(SerialPort& port, std::size_t count) {
  std::vector<std::byte> bytes(count);
  std::size_t have = 0;
  while (have < count) {
    const Result<std::size_t> got = port.Read(std::span(bytes).subspan(have), kAmple);
    if (!got) break;
    have += *got;
  }
  bytes.resize(have);
  return bytes;
}

template <class Line>
class SerialPortTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* why = Line::WhyUnavailable(); why != nullptr) GTEST_SKIP() << why;
    line_ = std::make_unique<Line>();
  }
  SerialPort& port() { return line_->port(); }
  Line& line() { return *line_; }

 private:
  std::unique_ptr<Line> line_;
};

template <class Line>
class SerialPortConformance : public SerialPortTest<Line> {};
template <class Line>
class SerialPortHangUp : public SerialPortTest<Line> {};
template <class Line>
class SerialPortStall : public SerialPortTest<Line> {};
template <class Line>
class SerialPortExclusive : public SerialPortTest<Line> {};
TYPED_TEST_SUITE_P(SerialPortConformance);
TYPED_TEST_SUITE_P(SerialPortHangUp);
TYPED_TEST_SUITE_P(SerialPortStall);
TYPED_TEST_SUITE_P(SerialPortExclusive);

TYPED_TEST_P(SerialPortConformance, IsDisconnectedUntilItIsOpenAndAfterItIsClosed) {
  std::byte byte{};
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(this->port().Write({&byte, 1}, kAmple).error(), Errc::kDisconnected);
    EXPECT_EQ(this->port().Read({&byte, 1}, kAmple).error(), Errc::kDisconnected);
    this->port().Close();
    ASSERT_TRUE(this->port().Open());
    this->port().Close();
  }
}

TYPED_TEST_P(SerialPortConformance, OpeningAnOpenPortKeepsItAndItsInput) {
  ASSERT_TRUE(this->port().Open());
  const auto sent = Bytes(3);
  this->line().FarSend(sent);
  ASSERT_TRUE(this->port().Open());
  EXPECT_EQ(ReadAll(this->port(), 3), sent);
}

TYPED_TEST_P(SerialPortConformance, EveryByteValuePassesUnchangedBothWays) {
  ASSERT_TRUE(this->port().Open());
  const auto all = Bytes(256);
  ASSERT_EQ(this->port().Write(all, kAmple), 256U);
  EXPECT_EQ(this->line().FarReceive(256), all);
  this->line().FarSend(all);
  EXPECT_EQ(ReadAll(this->port(), 256), all);
}

TYPED_TEST_P(SerialPortConformance, NothingIsEchoed) {
  ASSERT_TRUE(this->port().Open());
  const auto message = Bytes(8, 'a');
  ASSERT_EQ(this->port().Write(message, kAmple), 8U);
  this->line().FarSend(message);
  ASSERT_EQ(this->line().FarReceive(8).size(), 8U);
  ASSERT_EQ(ReadAll(this->port(), 8).size(), 8U);
  std::byte byte{};
  EXPECT_EQ(this->port().Read({&byte, 1}, kBrief).error(), Errc::kTimeout);
}

TYPED_TEST_P(SerialPortConformance, ReadGivesWhatHasArrivedWithoutWaitingForMore) {
  ASSERT_TRUE(this->port().Open());
  this->line().FarSend(Bytes(2));
  std::vector<std::byte> buffer(64);
  const Time before = this->line().clock().Now();
  const Result<std::size_t> count = this->port().Read(buffer, kAmple);
  ASSERT_TRUE(count);
  EXPECT_GE(*count, 1U);
  EXPECT_LE(*count, 2U);
  EXPECT_LT(this->line().clock().Now() - before, kAmple);
}

TYPED_TEST_P(SerialPortConformance, AShortBufferLeavesTheRestForTheNextRead) {
  ASSERT_TRUE(this->port().Open());
  const auto sent = Bytes(5);
  this->line().FarSend(sent);
  std::vector<std::byte> got;
  std::byte byte{};
  while (got.size() < 5 && this->port().Read({&byte, 1}, kAmple) == 1U) got.push_back(byte);
  EXPECT_EQ(got, sent);
}

TYPED_TEST_P(SerialPortConformance, SilenceEndsAtTheDeadline) {
  ASSERT_TRUE(this->port().Open());
  std::byte byte{};
  EXPECT_EQ(this->port().Read({&byte, 1}, milliseconds(0)).error(), Errc::kTimeout);
  const Time before = this->line().clock().Now();
  EXPECT_EQ(this->port().Read({&byte, 1}, kBrief).error(), Errc::kTimeout);
  EXPECT_GE(this->line().clock().Now() - before, kBrief);
}

TYPED_TEST_P(SerialPortConformance, SignalsNeitherEndNorFailAWait) {
  ASSERT_TRUE(this->port().Open());
  struct sigaction count {};
  struct sigaction before {};
  count.sa_handler = [](int) {};  // without SA_RESTART: calls of the system end with EINTR
  ASSERT_EQ(sigaction(SIGALRM, &count, &before), 0);
  const itimerval every = {.it_interval = {.tv_sec = 0, .tv_usec = 2000},
                           .it_value = {.tv_sec = 0, .tv_usec = 2000}};
  ASSERT_EQ(setitimer(ITIMER_REAL, &every, nullptr), 0);
  std::byte byte{};
  const Time start = this->line().clock().Now();
  const Result<std::size_t> silence = this->port().Read({&byte, 1}, kBrief);
  const Duration waited = this->line().clock().Now() - start;
  const itimerval off{};
  setitimer(ITIMER_REAL, &off, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_EQ(silence.error(), Errc::kTimeout);
  EXPECT_GE(waited, kBrief);
}

TYPED_TEST_P(SerialPortConformance, EmptySpansAreAnsweredAtOnce) {
  ASSERT_TRUE(this->port().Open());
  EXPECT_EQ(this->port().Write({}, kAmple), 0U);
  EXPECT_EQ(this->port().Read({}, kAmple).error(), Errc::kInvalidArgument);
}

TYPED_TEST_P(SerialPortConformance, NothingIsUnsentOnceItHasArrivedOrTheLineIsClosed) {
  EXPECT_EQ(this->port().Unsent(), 0U);
  ASSERT_TRUE(this->port().Open());
  ASSERT_EQ(this->port().Write(Bytes(64), kAmple), 64U);
  EXPECT_LE(this->port().Unsent(), 64U);
  ASSERT_EQ(this->line().FarReceive(64).size(), 64U);
  EXPECT_EQ(this->port().Unsent(), 0U);
  this->port().Close();
  EXPECT_EQ(this->port().Unsent(), 0U);
}

TYPED_TEST_P(SerialPortConformance, WorksAgainAfterCloseAndOpen) {
  ASSERT_TRUE(this->port().Open());
  this->port().Close();
  ASSERT_TRUE(this->port().Open());
  const auto message = Bytes(16);
  ASSERT_EQ(this->port().Write(message, kAmple), 16U);
  EXPECT_EQ(this->line().FarReceive(16), message);
}

TYPED_TEST_P(SerialPortConformance, ReadingAndWritingAllocateNothing) {
  using facewire::test::AllocationCounter;
  if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  ASSERT_TRUE(this->port().Open());
  const auto message = Bytes(64);
  std::vector<std::byte> buffer(64);
  this->line().FarSend(message);
  AllocationCounter counter;
  counter.Arm();
  const Result<std::size_t> written = this->port().Write(message, kAmple);
  const Result<std::size_t> read = this->port().Read(buffer, kAmple);
  (void)this->port().Unsent();
  counter.Disarm();
  counter.PrintFirst();
  EXPECT_EQ(written, 64U);
  EXPECT_TRUE(read);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

REGISTER_TYPED_TEST_SUITE_P(SerialPortConformance, IsDisconnectedUntilItIsOpenAndAfterItIsClosed,
                            OpeningAnOpenPortKeepsItAndItsInput,
                            EveryByteValuePassesUnchangedBothWays, NothingIsEchoed,
                            ReadGivesWhatHasArrivedWithoutWaitingForMore,
                            AShortBufferLeavesTheRestForTheNextRead, SilenceEndsAtTheDeadline,
                            SignalsNeitherEndNorFailAWait, EmptySpansAreAnsweredAtOnce,
                            NothingIsUnsentOnceItHasArrivedOrTheLineIsClosed,
                            WorksAgainAfterCloseAndOpen, ReadingAndWritingAllocateNothing);

TYPED_TEST_P(SerialPortHangUp, ADeviceThatGoesIsDisconnectedForReaders) {
  ASSERT_TRUE(this->port().Open());
  this->line().Unplug();
  std::byte byte{};
  EXPECT_EQ(this->port().Read({&byte, 1}, kAmple).error(), Errc::kDisconnected);
  EXPECT_EQ(this->port().Read({&byte, 1}, kAmple).error(), Errc::kDisconnected);
}

TYPED_TEST_P(SerialPortHangUp, ADeviceThatGoesIsDisconnectedForWriters) {
  ASSERT_TRUE(this->port().Open());
  this->line().Unplug();
  std::byte byte{};
  EXPECT_EQ(this->port().Write({&byte, 1}, kAmple).error(), Errc::kDisconnected);
  EXPECT_EQ(this->port().Write({&byte, 1}, kAmple).error(), Errc::kDisconnected);
}

TYPED_TEST_P(SerialPortHangUp, OpenFindsTheDeviceOnlyOnceItIsBack) {
  ASSERT_TRUE(this->port().Open());
  this->line().Unplug();
  std::byte byte{};
  EXPECT_EQ(this->port().Write({&byte, 1}, kAmple).error(), Errc::kDisconnected);
  EXPECT_EQ(this->port().Open().error(), Errc::kNotFound);
  EXPECT_EQ(this->port().Open().error(), Errc::kNotFound);
  this->line().Plug();
  ASSERT_TRUE(this->port().Open());
  const auto message = Bytes(16);
  ASSERT_EQ(this->port().Write(message, kAmple), 16U);
  EXPECT_EQ(this->line().FarReceive(16), message);
  this->line().FarSend(message);
  EXPECT_EQ(ReadAll(this->port(), 16), message);
}

REGISTER_TYPED_TEST_SUITE_P(SerialPortHangUp, ADeviceThatGoesIsDisconnectedForReaders,
                            ADeviceThatGoesIsDisconnectedForWriters,
                            OpenFindsTheDeviceOnlyOnceItIsBack);

inline constexpr std::size_t kMoreThanAnyBuffer = std::size_t{1} << 20U;

TYPED_TEST_P(SerialPortStall, AWriteThatNobodyTakesIsPartialAndThenTimesOut) {
  ASSERT_TRUE(this->port().Open());
  this->line().Stall();
  const auto much = Bytes(kMoreThanAnyBuffer);
  const Time before = this->line().clock().Now();
  const Result<std::size_t> part = this->port().Write(much, kBrief);
  ASSERT_TRUE(part);
  EXPECT_GT(*part, 0U);
  EXPECT_LT(*part, much.size());
  EXPECT_GE(this->line().clock().Now() - before, kBrief);
  // A terminal may find room for a few bytes more while its buffers move up.
  std::size_t taken = *part;
  Result<std::size_t> more = this->port().Write(std::span(much).subspan(taken), milliseconds(0));
  for (; more && taken < much.size();
       more = this->port().Write(std::span(much).subspan(taken), kBrief)) {
    taken += *more;
  }
  EXPECT_EQ(more.error(), Errc::kTimeout);
  EXPECT_EQ(this->port().Write(std::span(much).subspan(taken), milliseconds(0)).error(),
            Errc::kTimeout);

  // What was taken arrives whole and in order, and the line goes on from there.
  this->line().Resume();
  const auto arrived = this->line().FarReceive(taken);
  ASSERT_EQ(arrived.size(), taken);
  EXPECT_TRUE(std::equal(arrived.begin(), arrived.end(), much.begin()));
  const auto message = Bytes(16);
  ASSERT_EQ(this->port().Write(message, kAmple), 16U);
  EXPECT_EQ(this->line().FarReceive(16), message);
}

REGISTER_TYPED_TEST_SUITE_P(SerialPortStall, AWriteThatNobodyTakesIsPartialAndThenTimesOut);

TYPED_TEST_P(SerialPortExclusive, ASecondPortOfTheLineIsBusyUntilTheFirstCloses) {
  const std::unique_ptr<SerialPort> second = this->line().SecondPort();
  ASSERT_TRUE(this->port().Open());
  EXPECT_EQ(second->Open().error(), Errc::kBusy);
  this->port().Close();
  ASSERT_TRUE(second->Open());
  EXPECT_EQ(this->port().Open().error(), Errc::kBusy);
}

TYPED_TEST_P(SerialPortExclusive, ARefusedPortDoesNotDisturbTheOneThatHasTheLine) {
  const std::unique_ptr<SerialPort> second = this->line().SecondPort();
  ASSERT_TRUE(this->port().Open());
  this->line().FarSend(Bytes(4));
  EXPECT_EQ(second->Open().error(), Errc::kBusy);
  EXPECT_EQ(ReadAll(this->port(), 4), Bytes(4));
}

REGISTER_TYPED_TEST_SUITE_P(SerialPortExclusive, ASecondPortOfTheLineIsBusyUntilTheFirstCloses,
                            ARefusedPortDoesNotDisturbTheOneThatHasTheLine);

}  // namespace facewire::hal::test

#endif  // FACEWIRE_TESTS_HAL_SERIAL_PORT_CONFORMANCE_H_
