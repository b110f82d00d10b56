#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <vector>

#include "core/wire/decoder.h"
#include "tests/tools/firmware/firmware.h"
#include "tests/tools/firmware/firmware_line.h"

namespace facewire::firmware {
namespace {

// The receiver behind its decoder, and the device's end of the line.
struct Context {
  Line line;
  FwDecoder decoder;
  FwReceiver receiver;
  wire::Decoder host;

  explicit Context(const std::uint16_t* remembered = nullptr) {
    FwDecoderInit(&decoder);
    FwReceiverInit(&receiver, remembered);
  }
  void Receive(const Bytes& bytes) {
    for (const std::byte byte : bytes) {
      FwFrame frame;
      if (FwDecoderTake(&decoder, std::to_integer<std::uint8_t>(byte), &frame)) {
        FwReceiverTake(&receiver, &frame);
      }
    }
  }
  void Send(const wire::Message& message) { Receive(line.Send(message)); }
  void Tick(int ticks = 1) {
    for (; ticks > 0; --ticks) FwReceiverTick(&receiver);
  }
  // With fresh pulses before each tick.
  void Follow(const wire::ServoPulses& pulses, int ticks) {
    for (; ticks > 0; --ticks) {
      Send(pulses);
      Tick();
    }
  }
  // Following at 1800 us.
  void Settle() {
    Send(TwelveServos());
    Follow(AllAt(1800), 100);
    ASSERT_EQ(receiver.state, kFwFollowing);
    ASSERT_EQ(Us(), 1800);
  }
  double Us(std::uint8_t servo = 0) const { return FwReceiverPulse(&receiver, servo) / 2.0; }
  std::optional<wire::ReceiverStatus> Status() {
    if (!FwReceiverStatusDue(&receiver)) return {};
    std::array<std::uint8_t, FW_STATUS_FRAME_BYTES> bytes;
    const std::size_t size =
        FwReceiverWriteStatus(&receiver, &decoder.stats, 4, 4950, bytes.data());
    auto stream = std::as_bytes(std::span(bytes)).first(size);
    return std::get<wire::ReceiverStatus>(host.Next(stream).value().message);
  }
};

TEST(Receiver, WithoutASetupThereIsNoPulseWhateverComes) {
  Context context;
  context.Follow(AllAt(1500), 100);
  EXPECT_EQ(context.Us(), 0);
  EXPECT_EQ(context.receiver.state, kFwWaiting);
  EXPECT_EQ(context.receiver.refused, 100U);
}

TEST(Receiver, ASetupAloneMovesNothing) {
  Context context;
  context.Send(TwelveServos());
  context.Tick(1000);
  EXPECT_EQ(context.Us(), 0);
  EXPECT_EQ(context.receiver.state, kFwReleased);
}

TEST(Receiver, TheFirstPulsesCrawlFromNeutral) {
  Context context;
  context.Send(TwelveServos());
  context.Follow(AllAt(1800), 1);
  EXPECT_EQ(context.receiver.state, kFwRamping);
  EXPECT_NEAR(context.Us(), 1500, 1);
  double before = context.Us();
  double fastest = 0;
  int ticks = 0;
  while (context.receiver.state == kFwRamping && ticks < 200) {
    context.Follow(AllAt(1800), 1);
    fastest = std::max(fastest, context.Us() - before);
    before = context.Us();
    ++ticks;
  }
  EXPECT_LE(fastest, 10.5);  // 500 us/s
  EXPECT_NEAR(ticks * FW_TICK_MS, 850, 100);
  context.Follow(AllAt(1800), 3);
  EXPECT_EQ(context.Us(), 1800);
  EXPECT_EQ(context.receiver.state, kFwFollowing);
}

TEST(Receiver, WhereTheServosWereBeforeAResetIsWhereTheyStart) {
  std::array<std::uint16_t, FW_SERVOS> remembered;
  remembered.fill(4 * 1700);
  remembered[1] = 0;
  remembered[2] = 4 * 2400;  // a limit that was wider
  Context context(remembered.data());
  context.Send(TwelveServos());
  context.Follow(AllAt(1700), 1);
  EXPECT_EQ(context.Us(0), 1700);
  EXPECT_NEAR(context.Us(1), 1500, 1);
  EXPECT_NEAR(context.Us(2), 2000, 1);
}

TEST(Receiver, WhatIsAskedForIsKeptWithinTheLimitsAndTheSpeed) {
  Context context;
  context.Settle();
  context.Follow(AllAt(2500), 1);
  EXPECT_EQ(context.Us(), 1880);  // 4000 us/s
  context.Follow(AllAt(2500), 10);
  EXPECT_EQ(context.Us(), 2000);
  context.Follow(AllAt(500), 40);
  EXPECT_EQ(context.Us(), 1000);
}

TEST(Receiver, SilenceHoldsEasesRestsAndReleasesEachInItsTime) {
  Context context;
  context.Settle();
  std::vector<std::pair<int, FwState>> changes;
  FwState last = context.receiver.state;
  for (int ms = FW_TICK_MS; ms <= 2000; ms += FW_TICK_MS) {
    context.Tick();
    const FwState state = context.receiver.state;
    if (state != last) changes.emplace_back(ms, state);
    last = state;
    if (ms < 200) {
      EXPECT_EQ(context.Us(), 1800) << ms;
    }
    if (ms == 400) {
      EXPECT_NEAR(context.Us(), 1650, 2);
    }
    if (ms >= 600 && ms < 900) {
      EXPECT_EQ(context.Us(), 1500) << ms;
    }
    if (ms >= 900) {
      EXPECT_EQ(context.Us(), 0) << ms;
    }
  }
  EXPECT_THAT(changes,
              testing::ElementsAre(std::pair(100, kFwHolding), std::pair(200, kFwEasing),
                                   std::pair(600, kFwResting), std::pair(900, kFwReleased)));
}

TEST(Receiver, PulsesAgainAfterSilenceCrawlFromWhereItWas) {
  for (const int silent_ticks : {6, 15, 35, 60}) {
    Context context;
    context.Settle();
    context.Tick(silent_ticks);
    const double was = context.Us() == 0 ? 1500 : context.Us();
    context.Follow(AllAt(2000), 1);
    EXPECT_EQ(context.receiver.state, kFwRamping);
    EXPECT_NEAR(context.Us(), was, 1) << silent_ticks;
  }
}

TEST(Receiver, ALateFrameDoesNotDisturb) {
  Context context;
  context.Settle();
  for (int i = 0; i < 20; ++i) {
    context.Tick(4);  // 80 ms
    EXPECT_EQ(context.receiver.state, kFwFollowing);
    context.Follow(AllAt(1800 + 10 * i), 1);
    EXPECT_EQ(context.Us(), 1800 + 10 * i);
  }
}

TEST(Receiver, AStopEndsAllMotionWithTheNextTickUntilItIsOver) {
  Context context;
  context.Settle();
  context.Follow(AllAt(1000), 3);
  const double at = context.Us();
  wire::ServoPulses stop = AllAt(2000);
  stop.stop = true;
  for (int i = 0; i < 100; ++i) {
    context.Follow(stop, 1);
    ASSERT_EQ(context.Us(), at);
    ASSERT_EQ(context.receiver.state, kFwStopped);
  }
  context.Follow(AllAt(2000), 1);
  EXPECT_EQ(context.receiver.state, kFwRamping);
  EXPECT_NEAR(context.Us(), at, 1);
}

TEST(Receiver, AStopStartsNoPulsesAndAWidthOfNoneStillEndsThem) {
  Context context;
  context.Send(TwelveServos());
  wire::ServoPulses stop = AllAt(1600);
  stop.stop = true;
  context.Follow(stop, 5);
  EXPECT_EQ(context.Us(), 0);

  context.Follow(AllAt(1600), 50);
  stop.quarter_us[3] = 0;
  context.Follow(stop, 1);
  EXPECT_EQ(context.Us(3), 0);
  EXPECT_EQ(context.Us(4), 1600);
  stop.quarter_us[3] = 6400;
  context.Follow(stop, 1);
  EXPECT_EQ(context.Us(3), 0);
}

TEST(Receiver, SilenceDuringAStopReleasesWithoutMoving) {
  Context context;
  context.Settle();
  wire::ServoPulses stop = AllAt(1200);
  stop.stop = true;
  context.Follow(stop, 1);
  for (int ms = FW_TICK_MS; ms < 900; ms += FW_TICK_MS) {
    context.Tick();
    ASSERT_EQ(context.Us(), 1800) << ms;
  }
  context.Tick();
  EXPECT_EQ(context.Us(), 0);
  EXPECT_EQ(context.receiver.state, kFwReleased);
}

TEST(Receiver, OneServoGoesLimpAndCrawlsBackWhileTheOthersFollow) {
  Context context;
  context.Settle();
  wire::ServoPulses pulses = AllAt(1800);
  pulses.quarter_us[2] = 0;
  context.Follow(pulses, 1);
  EXPECT_EQ(context.Us(2), 0);
  pulses = AllAt(1900);
  context.Follow(pulses, 2);
  EXPECT_NEAR(context.Us(2), 1800, 3);
  EXPECT_EQ(context.Us(3), 1900);
  EXPECT_EQ(context.receiver.state, kFwRamping);
}

TEST(Receiver, PulsesForAnotherSetupAreRefusedAndDoNotFeedTheFailsafe) {
  Context context;
  context.Settle();
  wire::ServoPulses few = AllAt(1800);
  (void)few.quarter_us.try_resize(11);
  for (int i = 0; i < 23; ++i) {
    context.Follow(AllAt(1800, 8), 1);
    context.Follow(few, 1);
  }
  EXPECT_EQ(context.receiver.state, kFwReleased);
  EXPECT_EQ(context.receiver.refused, 46U);
}

TEST(Receiver, ASetupThatItHasChangesNothingAndANewOneStartsAgain) {
  Context context;
  context.Settle();
  context.Send(TwelveServos());
  context.Follow(AllAt(1800), 1);
  EXPECT_EQ(context.receiver.state, kFwFollowing);

  wire::ServoSetup narrow = TwelveServos(9);
  for (wire::ServoLimits& servo : narrow.servos) servo.max_quarter_us = 4 * 1700;
  context.Send(narrow);
  EXPECT_EQ(context.Us(), 0);
  context.Follow(AllAt(1400, 9), 1);
  EXPECT_NEAR(context.Us(), 1700, 1);
  EXPECT_EQ(context.receiver.state, kFwRamping);
}

TEST(Receiver, ASetupOfMoreServosThanItHasPinsIsRefused) {
  Context context;
  wire::ServoSetup setup = TwelveServos();
  (void)setup.servos.try_push(setup.servos[0]);
  context.Send(setup);
  context.Tick();
  EXPECT_EQ(context.receiver.state, kFwWaiting);
  EXPECT_EQ(context.Status()->refused, 1U);
}

TEST(Receiver, ALimitBetweenTwoHalfMicrosecondsIsNotPassed) {
  Context context;
  wire::ServoSetup setup = TwelveServos();
  setup.servos[0].min_quarter_us = 4801;
  setup.servos[0].max_quarter_us = 7203;
  context.Send(setup);
  context.Follow(AllAt(2500), 200);
  EXPECT_EQ(context.Us(), 1800.5);
  context.Follow(AllAt(500), 200);
  EXPECT_EQ(context.Us(), 1200.5);
}

TEST(Receiver, ReportsOnceASecondAndWhenItsStateChanges) {
  Context context;
  EXPECT_EQ(context.Status()->state, wire::ReceiverState::kWaiting);
  int reports = 0;
  for (int i = 0; i < 500; ++i) {
    context.Tick();
    if (context.Status()) ++reports;
  }
  EXPECT_EQ(reports, 10);
  context.Send(TwelveServos());
  auto status = context.Status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->setup_id, 7U);
  EXPECT_EQ(status->state, wire::ReceiverState::kReleased);
  EXPECT_EQ(status->reset_causes, 4);
  EXPECT_EQ(status->supply_mv, 4950);
  EXPECT_EQ(status->uptime_ms, 10'000U);
  context.Follow(AllAt(1500), 1);
  status = context.Status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->frames, 2U);
  EXPECT_EQ(status->quarter_us[11], 6000);
}

TEST(Receiver, RefusedPulsesAreReportedSoonButNotEachTime) {
  Context context;
  (void)context.Status();
  int reports = 0;
  for (int i = 0; i < 100; ++i) {
    context.Follow(AllAt(1500), 1);
    if (context.Status()) ++reports;
  }
  EXPECT_NEAR(reports, 10, 1);
}

// An hour with everything that may go wrong: the rules hold at every tick.
TEST(Receiver, NothingThatArrivesMakesItMoveTooFarTooFastOrTooLong) {
  std::mt19937 random(23);
  const auto any = [&](int below) { return std::uniform_int_distribution(0, below - 1)(random); };
  Context context;
  std::array<double, FW_SERVOS> before{};
  std::uint32_t setup_id = 7;
  bool stopped = false;
  int silent_ticks = 1000;
  int sends_for = 0;
  context.Send(TwelveServos(setup_id));
  for (int tick = 0; tick < 3600 * 1000 / FW_TICK_MS; ++tick) {
    bool reached = false;
    bool new_setup = false;
    if (sends_for == 0) sends_for = any(3) == 0 ? -any(80) : any(400);
    sends_for += sends_for > 0 ? -1 : 1;
    if (any(2000) == 0) {
      ++setup_id;
      context.Send(TwelveServos(setup_id));
      new_setup = true;
    }
    if (any(200) == 0) stopped = !stopped;
    if (sends_for > 0) {
      wire::ServoPulses pulses = AllAt(1500, setup_id);
      for (std::uint16_t& width : pulses.quarter_us) {
        width = static_cast<std::uint16_t>(any(50) == 0 ? 0 : 2000 + any(8001));
      }
      pulses.stop = stopped;
      Bytes bytes = context.line.Send(pulses);
      reached = any(10) != 0;
      if (!reached) bytes[1 + static_cast<std::size_t>(any(30))] ^= std::byte{0x20};
      context.Receive(bytes);
    }
    if (any(30) == 0) {
      for (int i = any(50); i > 0; --i) context.Receive({static_cast<std::byte>(any(256))});
      context.Receive({std::byte{0}});
    }
    const bool was_stopped = context.receiver.state == kFwStopped;
    context.Tick();
    silent_ticks = reached ? 0 : silent_ticks + 1;

    for (std::uint8_t i = 0; i < FW_SERVOS; ++i) {
      const double us = context.Us(i);
      double& last = before[i];
      const bool moved = us != 0 && last != 0 && us != last;
      ASSERT_TRUE(us == 0 || (us >= 1000 && us <= 2000)) << tick;
      if (moved && !new_setup) {
        ASSERT_LE(std::abs(us - last), 80.5) << tick;  // 4000 us/s, half a microsecond
      }
      // A stop holds from the tick that it reached, or began at.
      if (moved) {
        ASSERT_FALSE(reached && stopped) << tick;
      }
      if (moved && was_stopped) {
        ASSERT_TRUE(reached && !stopped) << tick;
      }
      if (silent_ticks * FW_TICK_MS >= 900) {
        ASSERT_EQ(us, 0) << tick;
      }
      last = us;
    }
  }
}

}  // namespace
}  // namespace facewire::firmware
