#include "core/bus/maestro_bus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "tests/core/bus/chain_peer.h"

namespace facewire::bus {
namespace {

using std::chrono::milliseconds;

// A board that hears compact packets without CRC; targets are at once its pulses.
struct Board {
  bool answers = true;
  std::map<int, int> pulses;  // by channel, 0.25 us; 0: none
  int errors = 0;
  int largest = 16383;                       // of a channel's range
  std::vector<std::pair<int, int>> targets;  // all that came
  int packets = 0, multi = 0;

  Bytes Hear(std::span<const std::byte> bytes) {
    Bytes reply;
    std::size_t i = 0;
    const auto next = [&] { return i < bytes.size() ? std::to_integer<int>(bytes[i++]) : 0; };
    const auto set = [&](int channel) {
      const int low = next();
      const int target = low | next() << 7;
      targets.emplace_back(channel, target);
      pulses[channel] = std::min(target, largest);
    };
    const auto say = [&](int value) {
      if (!answers) return;
      reply.push_back(static_cast<std::byte>(value & 0xFF));
      reply.push_back(static_cast<std::byte>(value >> 8));
    };
    while (i < bytes.size()) {
      ++packets;
      switch (next()) {
        case 0x84:
          set(next());
          break;
        case 0x9F: {
          ++multi;
          const int count = next();
          const int first = next();
          for (int n = 0; n < count; ++n) set(first + n);
          break;
        }
        case 0x90:
          say(pulses[next()]);
          break;
        case 0xA1:
          say(errors);
          errors = 0;
          break;
        default:
          ADD_FAILURE() << "not a command";
      }
    }
    return reply;
  }
};

// Channels 0, 1, 2 and 5, 1000 to 2000 us, 20 ms ticks.
struct Context {
  MaestroConfig config;
  MaestroBus bus;
  Board board;
  std::vector<ServoCommand> commands{4};
  Time now = Time(Duration(1'000'000));
  bool cut = false;
  std::size_t last_bytes = 0;

  explicit Context(bool multi = false) {
    for (const std::uint8_t id : std::array<std::uint8_t, 4>{0, 1, 2, 5}) {
      (void)config.bus.servos.try_push({.id = id, .min = 1000, .max = 2000});
    }
    config.multi_target = multi;
    EXPECT_TRUE(bus.Configure(config));
  }
  const ServoFeedback& feedback(std::size_t i) { return bus.feedback()[i]; }
  void All(float position, bool torque = true) {
    for (ServoCommand& c : commands) c = {.position = position, .torque = torque};
  }
  void Tick() {
    const auto bytes = bus.Tick(now, commands);
    last_bytes = bytes.size();
    const Bytes reply = cut ? Bytes() : board.Hear(bytes);
    bus.Receive(reply, now + milliseconds(3));
    now += milliseconds(20);
  }
  void Run(Duration time) {
    for (const Time end = now + time; now < end;) Tick();
  }
  void RunUp() {
    Run(milliseconds(1000));
    All(1500);
    Run(milliseconds(1000));
    for (const ServoFeedback& f : bus.feedback()) EXPECT_EQ(f.state, ServoState::kOn);
  }
};

TEST(MaestroBus, ReadsErrorsAndPulsesBeforeItSaysThatItRuns) {
  Context c;
  c.board.errors = 0x20;  // of the time before
  c.board.pulses[1] = 5000;
  c.Tick();
  EXPECT_EQ(c.bus.status().state, BusState::kStarting);
  for (int i = 0; i < 50 && c.bus.status().state != BusState::kRunning; ++i) c.Tick();
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_EQ(c.bus.status().serial_errors, 0);
  EXPECT_EQ(c.feedback(0).state, ServoState::kLimp);
  EXPECT_FALSE(c.feedback(0).position) << "without pulses nobody knows";
  EXPECT_EQ(c.feedback(1).position, 1250) << "it went on from before";
  c.Tick();
  EXPECT_EQ(c.board.targets, (std::vector<std::pair<int, int>>{{1, 0}})) << "and is told to end";
}

TEST(MaestroBus, PulsesThatWentOnFromBeforeDoNotEndWhereTheMotionGoesOnFromThem) {
  Context c;
  c.board.pulses[1] = 5000;
  while (c.feedback(1).state != ServoState::kLimp) c.Tick();
  EXPECT_EQ(c.feedback(1).factor, 1);
  c.commands[1] = {.position = *c.feedback(1).position, .torque = true};
  c.Run(milliseconds(1000));
  ASSERT_FALSE(c.board.targets.empty());
  for (const auto& target : c.board.targets) EXPECT_EQ(target, std::pair(1, 5000));
}

TEST(MaestroBus, FirstPulsesComeOneAfterTheOther) {
  Context c;
  c.Run(milliseconds(500));
  c.All(1500);
  for (int i = 0; i < 20; ++i) {
    const std::size_t before = c.board.targets.size();
    c.Tick();
    std::set<int> fresh;
    for (std::size_t n = before; n < c.board.targets.size(); ++n) {
      fresh.insert(c.board.targets[n].first);
    }
    if (i < 6) {
      EXPECT_LE(fresh.size(), 1U + static_cast<unsigned>(i) / 2);
    }
  }
  for (const int channel : {0, 1, 2, 5}) EXPECT_EQ(c.board.pulses[channel], 6000);
}

TEST(MaestroBus, APositionIsRoundedToAQuarterMicrosecondAndStaysInItsRange) {
  Context c;
  c.RunUp();
  for (const auto& [position, pulse] : {std::pair(1500.1F, 6000),
                                        {1500.13F, 6001},
                                        {500.0F, 4000},
                                        {1e20F, 8000},
                                        {std::nanf(""), 8000}}) {
    c.commands[0].position = position;
    c.Tick();
    EXPECT_EQ(c.board.pulses[0], pulse) << position;
  }
}

TEST(MaestroBus, AStillFaceSendsNothingNewAndFeedsTheBoard) {
  Context c;
  c.RunUp();
  c.board.targets.clear();
  Time fed = c.now;
  for (int i = 0; i < 500; ++i) {
    c.Tick();
    if (c.last_bytes != 0) fed = c.now;
    ASSERT_LT(c.now - fed, milliseconds(120));
  }
  for (const auto& [channel, target] : c.board.targets) EXPECT_EQ(target, 6000);
  EXPECT_NEAR(static_cast<double>(c.board.targets.size()), 400, 10);  // 4 servos, 10 s, 100 ms
}

TEST(MaestroBus, NeighboursGoTogetherWhereTheBoardKnowsHow) {
  for (const bool multi : {false, true}) {
    Context c(multi);
    c.RunUp();
    c.board.multi = 0;
    c.All(1600);
    c.Tick();
    EXPECT_EQ(c.board.multi, multi ? 1 : 0);
    for (const int channel : {0, 1, 2, 5}) EXPECT_EQ(c.board.pulses[channel], 6400);
  }
}

TEST(MaestroBus, PulsesEndWhenTorqueIsNotWantedAndThenAllIsQuiet) {
  Context c;
  c.RunUp();
  c.All(1500, false);
  c.Run(milliseconds(1000));
  for (const auto& [channel, pulse] : c.board.pulses) EXPECT_EQ(pulse, 0);
  EXPECT_FALSE(c.feedback(0).torque);
  c.board.targets.clear();
  c.Run(milliseconds(5000));
  EXPECT_TRUE(c.board.targets.empty());
}

TEST(MaestroBus, ErrorsAreNamedAndWhoWasSentHomeStartsAnew) {
  Context c;
  c.RunUp();
  c.board.errors = 0x10;
  c.Run(milliseconds(200));
  EXPECT_EQ(c.bus.status().serial_errors, 0x10);
  // Its home is "off": it ends the pulses again and again, faster than the driver refreshes.
  for (int i = 0; i < 50; ++i) {
    c.board.pulses[0] = 0;
    c.Tick();
    if (c.bus.status().torque_lost != 0) break;
  }
  EXPECT_EQ(c.bus.status().torque_lost, 1U);
  c.Tick();
  EXPECT_EQ(c.feedback(0).factor, 0) << "so that the motion begins with a crawl";
  c.Run(milliseconds(1500));
  EXPECT_EQ(c.feedback(0).factor, 1);
  EXPECT_EQ(c.board.pulses[0], 6000);
}

TEST(MaestroBus, ABoardWithNarrowerLimitsIsFoundOut) {
  Context c;
  c.RunUp();
  EXPECT_TRUE(c.bus.status().findings.empty());
  c.board.largest = 7000;
  c.commands[3].position = 1900;
  c.Run(milliseconds(4000));
  ASSERT_EQ(c.bus.status().findings.size(), 1U);
  EXPECT_EQ(c.bus.status().findings[0].servo, 3);
  EXPECT_EQ(c.bus.status().findings[0].setting, Setting::kPulseRange);
  EXPECT_EQ(c.bus.status().findings[0].found, 7000);
  EXPECT_EQ(c.bus.status().findings[0].wanted, 7600);
}

TEST(MaestroBus, ABoardThatFallsSilentIsAFaultUntilItIsBack) {
  Context c;
  c.RunUp();
  c.cut = true;
  c.Run(milliseconds(3000));
  EXPECT_EQ(c.bus.status().state, BusState::kFault);
  EXPECT_EQ(c.bus.status().fault, BusFault::kNobodyAnswers);
  EXPECT_EQ(c.feedback(0).reason, Reason::kAbsent);
  c.cut = false;
  c.Run(milliseconds(3000));
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  EXPECT_EQ(c.feedback(0).state, ServoState::kOn);
}

TEST(MaestroBus, ABoardThatIsNotHeardAnyMoreIsToldToLetGo) {
  Context c;
  c.RunUp();
  c.board.answers = false;
  c.Run(milliseconds(2000));
  EXPECT_EQ(c.bus.status().fault, BusFault::kNobodyAnswers);
  for (const auto& [channel, pulse] : c.board.pulses) EXPECT_EQ(pulse, 0);
  c.board.answers = true;
  c.Run(milliseconds(3000));
  for (const int channel : {0, 1, 2, 5}) EXPECT_EQ(c.board.pulses[channel], 6000);
}

TEST(MaestroBus, AReplyThatComesLateIsNotTakenForTheNext) {
  Context c;
  c.RunUp();
  const std::uint64_t before = c.bus.status().replies;
  for (int i = 0; i < 200; ++i) {
    const Bytes reply = c.board.Hear(c.bus.Tick(c.now, c.commands));
    // Every tenth reply comes 30 ms late, when it has been given up.
    c.now += milliseconds(20);
    if (i % 10 != 0) {
      c.bus.Receive(reply, c.now - milliseconds(17));
      continue;
    }
    (void)c.board.Hear(c.bus.Tick(c.now, c.commands));
    c.now += milliseconds(20);
    (void)c.board.Hear(c.bus.Tick(c.now, c.commands));
    c.bus.Receive(reply, c.now);
    c.now += milliseconds(20);
  }
  EXPECT_EQ(c.bus.status().lost, 20U);
  EXPECT_EQ(c.bus.status().replies - before, 180U) << "a late one was taken for another's";
  EXPECT_EQ(c.bus.status().serial_errors, 0);
  EXPECT_TRUE(c.bus.status().findings.empty());
  EXPECT_EQ(c.bus.status().torque_lost, 0U);
}

TEST(MaestroBus, ABoardWhoseAnswersAreNotWiredIsDrivenAllTheSame) {
  Context c;
  c.board.answers = false;
  c.config.answers = false;
  ASSERT_TRUE(c.bus.Configure(c.config));
  c.Run(milliseconds(200));
  EXPECT_EQ(c.bus.status().state, BusState::kRunning);
  c.All(1500);
  c.Run(milliseconds(500));
  for (const int channel : {0, 1, 2, 5}) EXPECT_EQ(c.board.pulses[channel], 6000);
  EXPECT_TRUE(c.feedback(0).torque);
  c.All(1500, false);
  c.Tick();
  for (const auto& [channel, pulse] : c.board.pulses) EXPECT_EQ(pulse, 0);
}

TEST(MaestroBus, ReleaseEndsAllPulsesAtAnyMoment) {
  for (int moment = 0; moment < 60; ++moment) {
    Context c;
    c.All(1500);
    for (int i = 0; i < moment; ++i) c.Tick();
    c.bus.Receive(c.board.Hear(c.bus.Release(c.now)), c.now);
    for (const auto& [channel, pulse] : c.board.pulses) ASSERT_EQ(pulse, 0) << moment;
    c.All(1500, false);
    c.board.targets.clear();
    c.Run(milliseconds(2000));
    for (const auto& [channel, target] : c.board.targets) ASSERT_EQ(target, 0) << moment;
  }
}

TEST(MaestroBus, NoReplyHoweverDamagedMovesAServo) {
  std::mt19937 random(23);
  for (int round = 0; round < 100; ++round) {
    Context c(round % 2 == 0);
    std::set<int> commanded = {0};
    int quiet = 0;
    for (int i = 0; i < 500; ++i) {
      for (ServoCommand& command : c.commands) {
        command.position = 800 + static_cast<float>(random() % 5600) * 0.25F;
        command.torque = random() % 50 != 0;
        commanded.insert(
            static_cast<int>(std::lround(std::clamp(command.position, 1000.0F, 2000.0F) * 4)));
      }
      const auto bytes = c.bus.Tick(c.now, c.commands);
      quiet = bytes.empty() ? quiet + 1 : 0;
      ASSERT_LT(quiet, 60) << "it blocks";
      Bytes reply = c.board.Hear(bytes);
      switch (random() % 4) {
        case 0:
          reply.assign(random() % 20, std::byte{});
          for (std::byte& b : reply) b = static_cast<std::byte>(random());
          break;
        case 1:
          if (!reply.empty()) reply.pop_back();
          break;
        case 2:
          if (!reply.empty()) reply[0] = static_cast<std::byte>(random());
          break;
        default:
          break;
      }
      c.bus.Receive(reply, c.now + milliseconds(2));
      c.now += milliseconds(20);
    }
    for (const auto& [channel, target] : c.board.targets) {
      ASSERT_TRUE(commanded.contains(target)) << target;
      ASSERT_TRUE(channel <= 2 || channel == 5) << channel;
    }
    c.All(1500);
    c.Run(milliseconds(5000));
    for (const int channel : {0, 1, 2, 5}) ASSERT_EQ(c.board.pulses[channel], 6000) << round;
  }
}

TEST(MaestroBus, AConfigurationThatMakesNoSenseIsRefused) {
  const auto error = [](auto change) {
    Context c;
    change(c.config);
    const auto done = c.bus.Configure(c.config);
    return done ? Errc{} : done.error();
  };
  EXPECT_EQ(error([](MaestroConfig&) {}), Errc{});
  EXPECT_EQ(error([](MaestroConfig& m) { m.bus.servos.clear(); }), Errc::kOutOfRange);
  EXPECT_EQ(error([](MaestroConfig& m) { m.bus.servos[0].id = 24; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](MaestroConfig& m) { m.bus.servos[0].id = 1; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](MaestroConfig& m) { m.bus.servos[0].min = 0; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](MaestroConfig& m) { m.bus.servos[0].max = 5000; }), Errc::kOutOfRange);
  EXPECT_EQ(error([](MaestroConfig& m) { m.line.device = 128; }), Errc::kOutOfRange);
  MaestroBus bus;
  EXPECT_TRUE(bus.Tick(Time(), {}).empty());
  EXPECT_TRUE(bus.Release(Time()).empty());
}

TEST(MaestroBus, ItsServosCannotBeRebooted) {
  Context c;
  EXPECT_EQ(c.bus.Reboot(0).error(), Errc::kUnsupported);
  EXPECT_EQ(c.bus.Reboot(4).error(), Errc::kOutOfRange);
}

}  // namespace
}  // namespace facewire::bus
