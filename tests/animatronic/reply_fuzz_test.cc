#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <string>
#include <vector>

#include "tests/animatronic/performers.h"
#include "tests/animatronic/stage.h"

// Whatever a bus says to its driver: no crash, no hang, no command that the motion did not make, no
// torque that nobody wished for; and when the nonsense ends, everybody is back in time.

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kSeconds = FACEWIRE_FUZZ_SECONDS;  // of nonsense for each bus and kind of it
// A forged heat or fault lets a servo rest for 5 s (GuardConfig::rest); a forged setting is read
// again, a lost servo looked for each half a second.
constexpr Duration kRecovers = seconds(8);

enum class Nonsense : std::uint8_t { kRandom, kMutated, kReplayed, kFlood };
constexpr std::array kAllNonsense = {Nonsense::kRandom, Nonsense::kMutated, Nonsense::kReplayed,
                                     Nonsense::kFlood};
const char* Name(Nonsense nonsense) {
  constexpr std::array kNames = {"random", "mutated", "replayed", "flood"};
  return kNames[static_cast<std::size_t>(nonsense)];
}

class Liar {
 public:
  Liar(Nonsense nonsense, std::uint64_t seed) : nonsense_(nonsense), random_(seed) {}

  void operator()(std::vector<std::byte>& bytes) {
    if (!bytes.empty()) said_.push_back(bytes);
    if (said_.size() > 100) said_.pop_front();
    switch (nonsense_) {
      case Nonsense::kRandom:
        if (random_.Chance(0.5)) bytes = Random(random_.Next() % 40);
        break;
      case Nonsense::kMutated:
        if (random_.Chance(0.5)) Mutate(bytes);
        break;
      case Nonsense::kReplayed:
        // What was true once, in place of what is or on top of it.
        if (!random_.Chance(0.5) || said_.empty()) break;
        if (random_.Chance(0.5)) bytes.clear();
        Append(bytes, said_[random_.Next() % said_.size()]);
        break;
      case Nonsense::kFlood:
        if (random_.Chance(0.1)) Append(bytes, Random(random_.Next() % 20'000));
        if (random_.Chance(0.1)) Append(bytes, std::vector(5000, std::byte{0xFF}));
        break;
    }
  }

 private:
  std::vector<std::byte> Random(std::size_t size) {
    std::vector<std::byte> bytes(size);
    for (std::byte& b : bytes) b = std::byte{random_.Byte()};
    return bytes;
  }
  static void Append(std::vector<std::byte>& bytes, const std::vector<std::byte>& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  void Mutate(std::vector<std::byte>& bytes) {
    for (auto n = 1 + random_.Next() % 3; n > 0 && !bytes.empty(); --n) {
      const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(random_.Next() % bytes.size());
      switch (random_.Next() % 4) {
        case 0:
          *at ^= std::byte{static_cast<std::uint8_t>(1U << (random_.Next() % 8))};
          break;
        case 1:
          *at = std::byte{random_.Byte()};
          break;
        case 2:
          bytes.erase(at);
          break;
        default:
          bytes.insert(at, std::byte{random_.Byte()});
      }
    }
  }

  Nonsense nonsense_;
  sim::Random random_;
  std::deque<std::vector<std::byte>> said_;
};

class FuzzedReplies : public testing::TestWithParam<Kind> {};

TEST_P(FuzzedReplies, NeverMoveAServoAndAreForgottenInTime) {
  for (const Nonsense nonsense : kAllNonsense) {
    Stage stage(OneKind(GetParam(), 3));
    stage.performer = Moving;
    stage.Run(seconds(3));
    const auto feedback = [&](std::size_t i) { return stage.head.feedback(i).state; };
    stage.line(0).damage = Liar(nonsense, 1);
    std::uint64_t driven = 0;
    for (const Time end = stage.now() + seconds(kSeconds); stage.now() < end;) {
      stage.Tick();
      for (std::size_t i = 0; i < 3; ++i) driven += stage.seen(i).torque ? 1 : 0;
    }
    stage.line(0).damage = {};
    const Time over = stage.now();
    EXPECT_TRUE(stage.RunUntil([&] { return stage.AllOn(); }, kRecovers))
        << Name(nonsense) << ' ' << bus::Name(feedback(0)) << ' ' << bus::Name(feedback(1)) << ' '
        << bus::Name(feedback(2));
    EXPECT_EQ(stage.judge->Report(), "") << Name(nonsense);
    EXPECT_GT(stage.judge->looks(), 0U);
    std::printf("| %-10s | %-8s | driven %3.0f %% of the time | back after %4.0f ms |\n",
                stage::Name(GetParam()), Name(nonsense),
                100.0 * static_cast<double>(driven) / (kSeconds * 300),
                static_cast<double>((stage.now() - over).count()) / 1000);
  }
}

TEST_P(FuzzedReplies, GiveNoTorqueThatNobodyWishedFor) {
  for (const Nonsense nonsense : kAllNonsense) {
    Stage stage(OneKind(GetParam(), 3));
    stage.performs = false;
    stage.line(0).damage = Liar(nonsense, 2);
    for (const Time end = stage.now() + seconds(kSeconds); stage.now() < end;) {
      stage.Tick();
      for (std::size_t i = 0; i < 3; ++i) ASSERT_FALSE(stage.seen(i).torque) << Name(nonsense);
    }
  }
}

// From the first byte on: no path is ever confirmed but by what the servo itself said.
TEST_P(FuzzedReplies, FromTheStartGiveTorqueOnlyToServosOfWhichTheMotionKnows) {
  for (const Nonsense nonsense : kAllNonsense) {
    Stage stage(OneKind(GetParam(), 3));
    stage.performer = Moving;
    stage.line(0).damage = Liar(nonsense, 3);
    stage.Run(seconds(kSeconds));
    EXPECT_EQ(stage.judge->Report(), "") << Name(nonsense);
  }
}

INSTANTIATE_TEST_SUITE_P(Buses, FuzzedReplies, testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(stage::Name(kind.param)); });

}  // namespace
}  // namespace facewire::stage
