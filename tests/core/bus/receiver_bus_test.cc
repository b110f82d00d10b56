#include "core/bus/receiver_bus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <variant>
#include <vector>

#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "tests/core/bus/chain_peer.h"

namespace facewire::bus {
namespace {

using std::chrono::milliseconds;

// A receiver whose pulses are at once what it is told. It obeys the setup that it has alone.
struct Peer {
  std::uint8_t capacity = 12;
  bool answers = true;
  wire::ServoSetup setup{.setup_id = 0};
  wire::ReceiverState state = wire::ReceiverState::kWaiting;
  std::vector<std::uint16_t> pulses;  // present
  std::vector<wire::ServoSetup> setups;
  std::vector<wire::ServoPulses> frames;  // those that were obeyed
  std::uint32_t refused = 0;
  std::uint16_t supply_mv = 4900;
  wire::Decoder decoder;
  wire::Encoder encoder;
  std::optional<Time> said_at;
  bool report = false;

  void Enter(wire::ReceiverState next) {
    report = report || next != state;
    state = next;
  }
  void Take(const wire::ServoSetup& s) {
    setups.push_back(s);
    if (s.servos.size() > capacity) {
      ++refused;
    } else if (s.setup_id != setup.setup_id) {
      setup = s;
      pulses.assign(s.servos.size(), 0);
      state = wire::ReceiverState::kReleased;
      report = true;
    }
  }
  void Take(const wire::ServoPulses& p) {
    if (setup.setup_id == 0 || p.setup_id != setup.setup_id ||
        p.quarter_us.size() != setup.servos.size()) {
      ++refused;
      return;
    }
    frames.push_back(p);
    pulses.assign(p.quarter_us.begin(), p.quarter_us.end());
    Enter(p.stop ? wire::ReceiverState::kStopped : wire::ReceiverState::kFollowing);
  }
  template <class Other>
  void Take(const Other&) {
    ADD_FAILURE() << "not for a receiver";
  }
  Bytes Status() {
    wire::ReceiverStatus status{.setup_id = setup.setup_id,
                                .state = state,
                                .capacity = capacity,
                                .supply_mv = supply_mv,
                                .refused = refused};
    for (const std::uint16_t width : pulses) (void)status.quarter_us.try_push(width);
    std::array<std::byte, wire::kMaxFrameBytes> buffer;
    const auto frame = encoder.Encode(status, buffer).value();
    return {frame.begin(), frame.end()};
  }
  // What it hears, and what it says then.
  Bytes Hear(std::span<const std::byte> bytes, Time now) {
    for (;;) {
      const auto received = decoder.Next(bytes);
      if (!received && received.error() == Errc::kNotReady) break;
      if (received) std::visit([this](const auto& m) { Take(m); }, received->message);
    }
    if (!answers || (!report && said_at && now - *said_at < milliseconds(1000))) return {};
    report = false;
    said_at = now;
    return Status();
  }
  void StartAnew() {
    setup = {.setup_id = 0};
    pulses.clear();
    Enter(wire::ReceiverState::kWaiting);
    encoder = {};
  }
  // As its own failsafe does.
  void LetGo() {
    std::fill(pulses.begin(), pulses.end(), std::uint16_t{0});
    Enter(wire::ReceiverState::kReleased);
  }
};

// Outputs 0, 1, 2 and 5, 1000 to 2000 us, 10 ms ticks.
struct Context {
  ReceiverConfig config;
  ReceiverBus bus;
  Peer peer;
  std::vector<ServoCommand> commands{4};
  Time now = Time(Duration(1'000'000));
  bool cut = false;
  std::size_t last_bytes = 0;

  Context() {
    for (const std::uint8_t id : std::array<std::uint8_t, 4>{0, 1, 2, 5}) {
      (void)config.bus.servos.try_push({.id = id,
                                        .min = 1000,
                                        .max = 2000,
                                        .neutral = 1400,
                                        .arrive_speed_per_s = 300,
                                        .arrive_acceleration_per_s2 = 900,
                                        .top_speed_per_s = 5000});
    }
    config.bus.baud = 115'200;
    EXPECT_TRUE(bus.Configure(config));
  }
  const ServoFeedback& feedback(std::size_t i) { return bus.feedback()[i]; }
  int Pulse(std::size_t output) { return peer.pulses.at(output); }
  void All(float position, bool torque = true) {
    for (ServoCommand& c : commands) c = {.position = position, .torque = torque};
  }
  void Tick() {
    const auto bytes = bus.Tick(now, commands);
    last_bytes = bytes.size();
    if (!cut) bus.Receive(peer.Hear(bytes, now), now + milliseconds(3));
    now += milliseconds(10);
  }
  void Run(Duration time) {
    for (const Time end = now + time; now < end;) Tick();
  }
  void RunUp() {
    Run(milliseconds(300));
    All(1500);
    Run(milliseconds(700));
    for (const ServoFeedback& f : bus.feedback()) EXPECT_EQ(f.state, ServoState::kOn);
  }
};

TEST(ReceiverBus, GivesItsSetupFirstAndRunsWhenAStatusNamesIt) {
  Context c;
  EXPECT_EQ(c.bus.status().state, BusState::kStarting);
  EXPECT_EQ(c.feedback(0).state, ServoState::kAbsent);
  EXPECT_EQ(c.feedback(0).reason, Reason::kStarting);
  c.Run(milliseconds(200));
  ASSERT_EQ(c.peer.setups.size(), 1U);
  const wire::ServoSetup& setup = c.peer.setups[0];
  EXPECT_NE(setup.setup_id, 0U);
  EXPECT_EQ(setup.hold_ms, 400U);
  EXPECT_EQ(setup.ease_ms, 1500U);
  EXPECT_EQ(setup.release_ms, 5000U);
  ASSERT_EQ(setup.servos.size(), 6U) << "up to the highest output";
  EXPECT_EQ(setup.servos[5].min_quarter_us, 4000);
  EXPECT_EQ(setup.servos[5].neutral_quarter_us, 5600);
  EXPECT_EQ(setup.servos[5].max_quarter_us, 8000);
  EXPECT_EQ(setup.servos[5].speed_us_s, 5000);
  EXPECT_EQ(setup.servos[5].ramp_speed_us_s, 300);
  EXPECT_EQ(setup.servos[5].ramp_acceleration_10us_s2, 90);
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_EQ(c.feedback(0).state, ServoState::kLimp);
  EXPECT_EQ(c.feedback(0).factor, 1);
  EXPECT_FALSE(c.feedback(0).position) << "without pulses nobody knows";
  EXPECT_FLOAT_EQ(c.feedback(0).voltage_v.value_or(0), 4.9F);
  ASSERT_TRUE(c.bus.receiver());
  EXPECT_EQ(c.bus.receiver()->capacity, 12);
}

TEST(ReceiverBus, WhatHasNoLimitGetsTheWidestAndALimitIsRoundedDownButNotTo0) {
  Context c;
  ServoConfig& servo = c.config.bus.servos[0];
  servo.neutral = std::nanf("");
  servo.top_speed_per_s = 0;
  servo.arrive_acceleration_per_s2 = 0;
  servo.arrive_speed_per_s = 0.5F;
  c.config.bus.servos[1].arrive_acceleration_per_s2 = 3;
  c.config.bus.servos[1].top_speed_per_s = 1e9F;
  c.config.bus.servos[2].min = 1000.1F;
  c.config.bus.servos[2].max = 1999.9F;
  c.config.bus.servos[2].neutral = 1000.1F;
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.Run(milliseconds(50));
  const auto& servos = c.peer.setups.at(0).servos;
  EXPECT_EQ(servos[0].neutral_quarter_us, 6000);
  EXPECT_EQ(servos[0].speed_us_s, 65535);
  EXPECT_EQ(servos[0].ramp_acceleration_10us_s2, 65535);
  EXPECT_EQ(servos[0].ramp_speed_us_s, 1);
  EXPECT_EQ(servos[1].ramp_acceleration_10us_s2, 1);
  EXPECT_EQ(servos[1].speed_us_s, 65535);
  EXPECT_EQ(servos[2].min_quarter_us, 4001);
  EXPECT_EQ(servos[2].neutral_quarter_us, 4001);
  EXPECT_EQ(servos[2].max_quarter_us, 7999);
}

TEST(ReceiverBus, AnotherRigHasAnotherSetupIdAndTheSameOneKeepsIt) {
  const auto id = [](auto change) {
    Context c;
    change(c.config);
    EXPECT_TRUE(c.bus.Configure(c.config));
    c.Run(milliseconds(50));
    return c.peer.setups.at(0).setup_id;
  };
  const std::uint32_t same = id([](ReceiverConfig&) {});
  EXPECT_EQ(id([](ReceiverConfig&) {}), same);
  const std::set<std::uint32_t> all = {
      same,
      id([](ReceiverConfig& r) { r.hold += milliseconds(1); }),
      id([](ReceiverConfig& r) { r.ease += milliseconds(1); }),
      id([](ReceiverConfig& r) { r.release += milliseconds(1); }),
      id([](ReceiverConfig& r) { r.bus.servos[0].min += 1; }),
      id([](ReceiverConfig& r) { r.bus.servos[0].neutral += 1; }),
      id([](ReceiverConfig& r) { r.bus.servos[0].max += 1; }),
      id([](ReceiverConfig& r) { r.bus.servos[0].top_speed_per_s += 1; }),
      id([](ReceiverConfig& r) { r.bus.servos[0].arrive_speed_per_s += 1; }),
      id([](ReceiverConfig& r) { r.bus.servos[0].arrive_acceleration_per_s2 += 10; }),
      id([](ReceiverConfig& r) { r.bus.servos[3].id = 6; })};
  EXPECT_EQ(all.size(), 11U);
  EXPECT_FALSE(all.contains(0));
}

TEST(ReceiverBus, FirstPulsesComeOneAfterTheOther) {
  Context c;
  c.Run(milliseconds(300));
  c.All(1500);
  for (int i = 0; i < 20; ++i) {
    c.Tick();
    const auto on = std::count_if(c.peer.pulses.begin(), c.peer.pulses.end(),
                                  [](std::uint16_t width) { return width != 0; });
    EXPECT_LE(on, 1 + i / 5);
  }
  for (const std::size_t output : {0U, 1U, 2U, 5U}) EXPECT_EQ(c.Pulse(output), 6000);
  EXPECT_EQ(c.Pulse(3), 0) << "nobody's";
}

TEST(ReceiverBus, APositionIsRoundedToAQuarterMicrosecondAndStaysInItsRange) {
  Context c;
  c.RunUp();
  for (const auto& [position, pulse] : {std::pair(1500.1F, 6000),
                                        {1500.13F, 6001},
                                        {500.0F, 4000},
                                        {1e20F, 8000},
                                        {std::numeric_limits<float>::infinity(), 8000},
                                        {std::nanf(""), 8000}}) {
    c.commands[0].position = position;
    c.Tick();
    EXPECT_EQ(c.Pulse(0), pulse) << position;
  }
}

TEST(ReceiverBus, TorqueWithoutAPositionYetIsNoPulse) {
  Context c;
  c.All(std::nanf(""));
  c.Run(milliseconds(1000));
  for (const wire::ServoPulses& frame : c.peer.frames) {
    for (const std::uint16_t width : frame.quarter_us) EXPECT_EQ(width, 0);
  }
}

TEST(ReceiverBus, AStillFaceSendsNothingNewAndFeedsTheReceiver) {
  Context c;
  c.RunUp();
  c.peer.frames.clear();
  Time fed = c.now;
  for (int i = 0; i < 1000; ++i) {
    c.Tick();
    if (c.last_bytes != 0) fed = c.now;
    ASSERT_LT(c.now - fed, milliseconds(50)) << "one may be lost before the receiver holds";
  }
  for (const auto& frame : c.peer.frames) EXPECT_EQ(frame.quarter_us[0], 6000);
  EXPECT_NEAR(static_cast<double>(c.peer.frames.size()), 250, 10);
  EXPECT_EQ(c.peer.setups.size(), 1U);
}

TEST(ReceiverBus, ALineThatIsTooSlowForTheTickIsNotStuffed) {
  Context c;
  c.config.bus.baud = 9600;  // a frame of six pulses takes 31 ms
  ASSERT_TRUE(c.bus.Configure(c.config));
  std::size_t bytes = 0;
  for (int i = 0; i < 1000; ++i) {
    c.All(1500 + static_cast<float>(i % 100));
    c.Tick();
    bytes += c.last_bytes;
  }
  EXPECT_LE(bytes, 9600U + 400U);  // 10 s
  EXPECT_GE(bytes, 7000U);
  EXPECT_GT(c.bus.status().held_back, 500U);
}

TEST(ReceiverBus, PulsesEndAtOnceWhenTorqueIsNotWanted) {
  Context c;
  c.RunUp();
  c.All(1500, false);
  c.Tick();
  for (const std::uint16_t pulse : c.peer.pulses) EXPECT_EQ(pulse, 0);
  EXPECT_EQ(c.feedback(0).state, ServoState::kLimp);
  c.Run(milliseconds(1100));
  EXPECT_FALSE(c.feedback(0).torque);
  EXPECT_FALSE(c.feedback(0).position);
}

TEST(ReceiverBus, PositionAndTorqueAreWhatTheReceiverSays) {
  Context c;
  c.RunUp();
  c.All(1700);
  c.Run(milliseconds(1100));
  EXPECT_TRUE(c.feedback(3).torque);
  EXPECT_EQ(c.feedback(3).position, 1700);
  EXPECT_LE(c.now - c.feedback(3).position_read, milliseconds(1100));
}

// The device's program was started anew; the receiver holds its servos meanwhile.
TEST(ReceiverBus, AReceiverThatKeptRunningGoesOnAndTellsWhereItIs) {
  Context c;
  c.RunUp();
  c.commands[1].position = 1650;
  c.Run(milliseconds(100));
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.All(1500, false);
  c.peer.frames.clear();
  while (c.bus.status().state != BusState::kRunning && c.now < Time(milliseconds(5000))) {
    EXPECT_TRUE(c.peer.frames.empty()) << "it was told something before it had said anything";
    c.Tick();
  }
  EXPECT_EQ(c.feedback(1).state, ServoState::kLimp);
  EXPECT_EQ(c.feedback(1).position, 1650);
  c.All(1650);
  c.Tick();
  for (const std::size_t output : {0U, 1U, 2U, 5U}) {
    EXPECT_EQ(c.Pulse(output), 6600) << "all at once: they have their torque already";
  }
}

TEST(ReceiverBus, AReceiverThatStartsAnewGetsItsSetupAgainButNotAtEveryTick) {
  Context c;
  c.RunUp();
  c.peer.setups.clear();
  c.peer.StartAnew();
  c.bus.Receive(c.peer.Hear({}, c.now), c.now);
  EXPECT_EQ(c.feedback(0).state, ServoState::kChecking);
  EXPECT_EQ(c.feedback(0).factor, 0) << "so that the motion begins with a crawl";
  EXPECT_EQ(c.feedback(0).reason, Reason::kStarting);
  EXPECT_EQ(c.bus.status().torque_lost, 4U);
  EXPECT_EQ(c.bus.status().state, BusState::kChecking);
  c.Run(milliseconds(500));
  EXPECT_EQ(c.peer.setups.size(), 1U);
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_EQ(c.Pulse(5), 6000);
}

TEST(ReceiverBus, ASetupThatIsLostIsSaidAgainAfterAWhile) {
  Context c;
  c.cut = true;
  c.Run(milliseconds(100));
  c.cut = false;
  c.Run(milliseconds(1500));
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
}

// Its receiving pin is not connected, or another rig's program talks to it, too.
TEST(ReceiverBus, AReceiverThatNeverTakesTheSetupIsAFault) {
  Context c;
  for (int i = 0; i < 400; ++i) {
    const auto bytes = c.bus.Tick(c.now, c.commands);
    (void)bytes;
    c.bus.Receive(c.peer.Hear({}, c.now), c.now);
    c.now += milliseconds(10);
  }
  EXPECT_EQ(c.bus.status().state, BusState::kFault);
  EXPECT_EQ(c.bus.status().fault, BusFault::kNobodyAnswers);
  EXPECT_EQ(c.feedback(0).factor, 0);
  EXPECT_LE(c.bus.status().questions, 9U);
}

TEST(ReceiverBus, ALineThatEchoesIsNamed) {
  Context c;
  for (int i = 0; i < 400; ++i) {
    const auto bytes = c.bus.Tick(c.now, c.commands);
    c.bus.Receive(Bytes(bytes.begin(), bytes.end()), c.now);
    c.now += milliseconds(10);
  }
  EXPECT_EQ(c.bus.status().fault, BusFault::kEcho);
}

TEST(ReceiverBus, WhatIsBeyondItsOutputsIsRefusedAndTheOthersMove) {
  Context c;
  c.peer.capacity = 4;
  c.Run(milliseconds(1500));
  c.All(1500);
  c.Run(milliseconds(500));
  EXPECT_EQ(c.peer.setup.servos.size(), 3U);
  EXPECT_EQ(c.Pulse(2), 6000);
  EXPECT_EQ(c.feedback(3).state, ServoState::kRefused);
  EXPECT_EQ(c.feedback(3).reason, Reason::kSettings);
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  ASSERT_EQ(c.bus.status().findings.size(), 1U);
  const Finding& finding = c.bus.status().findings[0];
  EXPECT_EQ(finding.servo, 3);
  EXPECT_EQ(finding.setting, Setting::kOutputs);
  EXPECT_EQ(finding.found, 4);
  EXPECT_EQ(finding.wanted, 6);
  EXPECT_TRUE(finding.refused);
}

TEST(ReceiverBus, AReceiverWithoutOutputsIsAFault) {
  Context c;
  c.peer.capacity = 0;
  c.Run(milliseconds(2500));
  EXPECT_EQ(c.bus.status().state, BusState::kFault);
  EXPECT_EQ(c.bus.status().fault, BusFault::kSettings);
}

TEST(ReceiverBus, AReceiverThatFallsSilentIsAbsentUntilItIsBack) {
  Context c;
  c.RunUp();
  c.cut = true;
  c.Run(milliseconds(4000));
  EXPECT_EQ(c.feedback(0).state, ServoState::kOn) << "only some statuses are missing yet";
  EXPECT_GE(c.bus.status().lost, 2U);
  c.Run(milliseconds(2000));
  EXPECT_EQ(c.feedback(0).state, ServoState::kAbsent);
  EXPECT_EQ(c.feedback(0).reason, Reason::kAbsent);
  EXPECT_FALSE(c.feedback(0).position);
  EXPECT_EQ(c.bus.status().fault, BusFault::kNobodyAnswers);
  c.peer.LetGo();
  c.cut = false;
  c.Run(milliseconds(3000));
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_EQ(c.feedback(0).state, ServoState::kOn);
  EXPECT_EQ(c.Pulse(0), 6000);
}

TEST(ReceiverBus, AReceiverThatIsNotHeardAnyMoreIsToldToLetGo) {
  Context c;
  c.RunUp();
  c.peer.answers = false;
  c.Run(milliseconds(6000));
  for (const std::uint16_t pulse : c.peer.pulses) EXPECT_EQ(pulse, 0);
  c.peer.answers = true;
  c.Run(milliseconds(2000));
  EXPECT_EQ(c.Pulse(0), 6000);
}

TEST(ReceiverBus, PulsesThatTheReceiverEndedByItselfStartAnew) {
  Context c;
  c.RunUp();
  c.cut = true;  // what it says is heard, and what it is told is not
  for (int i = 0; i < 30; ++i) c.Tick();
  c.peer.LetGo();
  c.bus.Receive(c.peer.Hear({}, c.now), c.now);
  EXPECT_EQ(c.bus.status().torque_lost, 4U);
  c.Tick();
  EXPECT_EQ(c.feedback(0).factor, 0) << "so that the motion begins with a crawl";
  EXPECT_EQ(c.feedback(0).reason, Reason::kHardware);
  c.cut = false;
  c.Run(milliseconds(1500));
  EXPECT_EQ(c.feedback(0).factor, 1);
  EXPECT_EQ(c.Pulse(0), 6000);
}

TEST(ReceiverBus, AStatusThatWasOnItsWayWhenPulsesStartedIsNoLoss) {
  Context c;
  c.Run(milliseconds(300));
  const Bytes before = c.peer.Status();
  c.All(1500);
  c.Tick();
  c.bus.Receive(before, c.now);
  EXPECT_EQ(c.bus.status().torque_lost, 0U);
  EXPECT_EQ(c.feedback(0).state, ServoState::kOn);
}

TEST(ReceiverBus, ReleaseEndsAllPulsesAtAnyMomentAndIsAnsweredAtOnce) {
  for (int moment = 1; moment < 120; ++moment) {
    Context c;
    c.All(1500);
    for (int i = 0; i < moment; ++i) c.Tick();
    c.bus.Receive(c.peer.Hear(c.bus.Release(c.now), c.now), c.now);
    for (const std::uint16_t pulse : c.peer.pulses) ASSERT_EQ(pulse, 0) << moment;
    EXPECT_TRUE(c.peer.frames.back().stop);
    for (const ServoFeedback& f : c.bus.feedback()) ASSERT_FALSE(f.torque) << moment;
    c.All(1500, false);
    c.peer.frames.clear();
    c.Run(milliseconds(1000));
    for (const auto& frame : c.peer.frames) {
      EXPECT_TRUE(frame.stop) << "the first may have been lost";
      for (const std::uint16_t width : frame.quarter_us) ASSERT_EQ(width, 0) << moment;
    }
    c.All(1600);
    c.Run(milliseconds(500));
    EXPECT_EQ(c.Pulse(0), 6400);
    EXPECT_FALSE(c.peer.frames.back().stop);
  }
}

TEST(ReceiverBus, AfterARestartItLooksAnewAndWritesNothingButTheSetup) {
  Context c;
  c.RunUp();
  c.bus.Restart();
  EXPECT_EQ(c.bus.status().state, BusState::kStarting);
  EXPECT_EQ(c.feedback(0).state, ServoState::kAbsent);
  c.cut = true;
  std::size_t bytes = 0;
  for (int i = 0; i < 40; ++i) {
    c.Tick();
    bytes += c.last_bytes;
  }
  EXPECT_LE(bytes, wire::MaxFrameBytes(wire::ServoSetupPayloadBytes(6)));
  c.cut = false;
  c.Run(milliseconds(1500));
  EXPECT_EQ(c.feedback(0).state, ServoState::kOn);
}

TEST(ReceiverBus, AStatusCutAtAnyByteIsNoStatus) {
  Context c;
  c.RunUp();
  const std::size_t size = c.peer.Status().size();
  for (std::size_t cut = 0; cut + 1 < size; ++cut) {
    c.bus.Restart();
    c.now += milliseconds(10);
    (void)c.bus.Tick(c.now, c.commands);
    const Bytes whole = c.peer.Status();
    c.bus.Receive(std::span(whole).first(cut), c.now);
    EXPECT_EQ(c.feedback(0).state, ServoState::kAbsent) << cut;
    // And the rest of it later, in single bytes.
    for (std::size_t i = cut; i < size; ++i) {
      c.bus.Receive(std::span(whole).subspan(i, 1), c.now);
    }
    EXPECT_NE(c.feedback(0).state, ServoState::kAbsent) << cut;
  }
}

TEST(ReceiverBus, NoStatusHoweverDamagedMovesAServo) {
  std::mt19937 random(29);
  for (int round = 0; round < 60; ++round) {
    Context c;
    std::set<int> commanded = {0};
    for (int i = 0; i < 500; ++i) {
      for (ServoCommand& command : c.commands) {
        command.position = 800 + static_cast<float>(random() % 5600) * 0.25F;
        command.torque = random() % 50 != 0;
        commanded.insert(
            static_cast<int>(std::lround(std::clamp(command.position, 1000.0F, 2000.0F) * 4)));
      }
      if (random() % 20 == 0) c.peer.report = true;
      Bytes said = c.peer.Hear(c.bus.Tick(c.now, c.commands), c.now);
      switch (random() % 4) {
        case 0:
          said.assign(random() % 100, std::byte{});
          for (std::byte& b : said) b = static_cast<std::byte>(random());
          break;
        case 1:
          said.resize(said.empty() ? 0 : random() % said.size());
          break;
        case 2:
          if (!said.empty()) said[random() % said.size()] = static_cast<std::byte>(random());
          break;
        default:
          break;
      }
      c.bus.Receive(said, c.now + milliseconds(2));
      c.now += milliseconds(10);
    }
    for (const auto& frame : c.peer.frames) {
      for (std::size_t output = 0; output < frame.quarter_us.size(); ++output) {
        ASSERT_TRUE(commanded.contains(frame.quarter_us[output]));
        ASSERT_TRUE(output <= 2 || output == 5 || frame.quarter_us[output] == 0);
      }
    }
    c.All(1500);
    c.Run(milliseconds(3000));
    for (const std::size_t output : {0U, 1U, 2U, 5U}) ASSERT_EQ(c.Pulse(output), 6000) << round;
  }
}

TEST(ReceiverBus, AConfigurationThatMakesNoSenseIsRefused) {
  const auto error = [](auto change) {
    Context c;
    change(c.config);
    const auto done = c.bus.Configure(c.config);
    return done ? Errc{} : done.error();
  };
  const float nan = std::nanf("");
  EXPECT_EQ(error([](ReceiverConfig&) {}), Errc{});
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].id = 63; }), Errc{});
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos.clear(); }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].id = 64; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].id = 1; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].min = 499; }), Errc::kOutOfRange);
  EXPECT_EQ(error([&](ReceiverConfig& r) { r.bus.servos[0].min = nan; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].max = 2501; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].max = 999; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].neutral = 2001; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].neutral = 0; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].arrive_speed_per_s = 0; }),
            Errc::kOutOfRange);
  EXPECT_EQ(error([&](ReceiverConfig& r) { r.bus.servos[0].arrive_acceleration_per_s2 = nan; }),
            Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.servos[0].top_speed_per_s = -1; }),
            Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.bus.gone_after = 0; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.hold = milliseconds(-1); }), Errc::kOutOfRange);
  EXPECT_EQ(error([](ReceiverConfig& r) { r.release = Duration::max(); }), Errc::kOutOfRange);
  ReceiverBus bus;
  EXPECT_TRUE(bus.Tick(Time(), {}).empty());
  EXPECT_TRUE(bus.Release(Time()).empty());
  bus.Receive(Peer().Status(), Time());
  bus.Restart();
  EXPECT_EQ(bus.status().fault, BusFault::kNotConfigured);
}

TEST(ReceiverBus, ItsServosCannotBeRebooted) {
  Context c;
  EXPECT_EQ(c.bus.Reboot(0).error(), Errc::kUnsupported);
  EXPECT_EQ(c.bus.Reboot(4).error(), Errc::kOutOfRange);
}

}  // namespace
}  // namespace facewire::bus
