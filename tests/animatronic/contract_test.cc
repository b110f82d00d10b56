#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tests/animatronic/stage.h"

// The failsafe contract, measured at the servos: when wishes stop, and when a cable is cut at any
// byte of a tick.

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kNever = Time::max();

double Ms(Duration d) { return static_cast<double>(d.count()) / 1000; }

// When a servo's command left its place, when it was at neutral, and when the torque was gone.
struct Times {
  std::optional<Time> left, neutral, limp;
};

// Every servo at 0.8 of its range, and at rest.
void Settle(Stage& stage) {
  stage.late_frames = false;
  stage.performer = [](std::size_t, double) { return 0.8; };
  ASSERT_TRUE(stage.RunUntil([&] { return stage.AllOn(); }, seconds(5)));
  stage.Run(seconds(5));
  ASSERT_TRUE(stage.AllOn());
}

// What the servos' shafts do from now on: that is what a spectator sees.
class Stopwatch {
 public:
  explicit Stopwatch(Stage& stage) : stage_(stage), times_(stage.servos()), at_(stage.servos()) {
    for (std::size_t i = 0; i < times_.size(); ++i) at_[i] = stage.Part(i, stage.seen(i).position);
    stage_.on_look = [this] { Look(); };
  }
  ~Stopwatch() { stage_.on_look = {}; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  const Times& times(std::size_t servo) const { return times_[servo]; }

 private:
  void Look() {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      const Seen& seen = stage_.seen(i);
      const double part = stage_.Part(i, seen.position);
      Times& t = times_[i];
      if (!seen.torque && !t.limp) t.limp = stage_.now();
      if (std::abs(part - at_[i]) > 0.02 && !t.left) t.left = stage_.now();
      if (std::abs(part - 0.5) < 0.02 && !t.neutral) t.neutral = stage_.now();
    }
  }

  Stage& stage_;
  std::vector<Times> times_;
  std::vector<double> at_;
};

std::string Since(const std::optional<Time>& at, Time start) {
  return at ? std::to_string(std::lround(Ms(*at - start))) + " ms" : "-";
}

void PrintHead(const char* what) {
  std::printf("%s\n| bus | leaves its place | at neutral | limp |\n", what);
}
void Print(Stage& stage, std::size_t servo, const Times& t, Time start) {
  std::printf("| %-10s | %8s | %8s | %8s |\n", Name(stage.line_of(servo).options().kind),
              Since(t.left, start).c_str(), Since(t.neutral, start).c_str(),
              Since(t.limp, start).c_str());
}

// By the contract the last wish counts for 200 ms and is held for 400; by 0.02 of the range the
// easing has moved a little later. Neutral is reached 1500 ms after that, and torque ends 5 s
// later.
TEST(WhenWishesStop, TheContractIsTheSameAtTheServosOfAllBuses) {
  Stage stage(EveryKind(1));
  Settle(stage);
  stage.performs = false;
  const Time start = stage.now();
  const servo::Contract& c = stage.rig().contract;
  PrintHead("wishes stop");
  const Stopwatch watch(stage);
  stage.Run(seconds(9));
  double first = 1e9, last = 0;
  for (std::size_t i = 0; i < stage.servos(); ++i) {
    const Times& t = watch.times(i);
    Print(stage, i, t, start);
    ASSERT_TRUE(t.left && t.neutral && t.limp) << i;
    const double leaves = Ms(c.fresh + c.hold), eased = leaves + Ms(c.ease);
    const double limp = eased + Ms(c.limp);
    // The last wish was up to a frame old; a smooth step needs a fifth of its time for the first
    // tenth of its way; a tick, 20 ms of pulses twice, and the servo's lag.
    EXPECT_GE(Ms(*t.left - start), leaves - 40) << i;
    EXPECT_LE(Ms(*t.left - start), leaves + 0.25 * Ms(c.ease)) << i;
    EXPECT_GE(Ms(*t.neutral - start), eased - 0.3 * Ms(c.ease)) << i;
    EXPECT_LE(Ms(*t.neutral - start), eased + 100) << i;
    EXPECT_GE(Ms(*t.limp - start), limp - 40) << i;
    EXPECT_LE(Ms(*t.limp - start), limp + 100) << i;
    first = std::min(first, Ms(*t.limp - start));
    last = std::max(last, Ms(*t.limp - start));
  }
  EXPECT_LE(last - first, 90);
  EXPECT_EQ(stage.judge->Report(), "");
}

// An emergency stop: what the spectator sees.
TEST(AtAStop, AllServosAreLimpWithinATickAndTheirPulses) {
  Stage stage(EveryKind(3));
  Settle(stage);
  stage.head.Stop();
  stage.judge->Stopped(stage.now());
  const Time start = stage.now();
  PrintHead("emergency stop");
  const Stopwatch watch(stage);
  stage.Run(seconds(2));
  for (std::size_t i = 0; i < stage.servos(); ++i) {
    const Times& t = watch.times(i);
    if (stage.index_of(i) == 0) Print(stage, i, t, start);
    ASSERT_TRUE(t.limp);
    const Wire wire = stage.line_of(i).wire(stage.index_of(i));
    EXPECT_LE(*t.limp - start, wire.reaction + wire.lets_go) << i;
    EXPECT_FALSE(t.left) << i;
  }
  EXPECT_EQ(stage.judge->Report(), "");
}

// The cable between the host and one bus is cut after `bytes` more bytes; the servo's own means are
// all that is left.
struct Cut {
  Times times;
  std::optional<Time> own_means;  // the bus itself noticed: a timeout, a watchdog
  double strayed = 0;             // the shaft, of its range, until it left for good or for 20 s
  Time start{};
};
Cut CutAfter(const StageOptions& options, std::size_t bytes, Duration time) {
  Stage stage(options);
  Settle(stage);
  const double before = stage.Part(0, stage.seen(0).position);
  // In motion, so that every tick has something to say.
  const double began_s = stage.now_s();
  stage.performer = [=](std::size_t, double t_s) {
    return 0.8 - 0.02 * std::sin(6 * (t_s - began_s));
  };
  stage.Run(milliseconds(400));
  stage.line(0).CutAfter(bytes);
  Cut cut;
  const Stopwatch watch(stage);
  for (const Time end = stage.now() + time; stage.now() < end;) {
    if (!stage.line(0).deaf) cut.start = stage.now();
    for (std::size_t i = 0; i < stage.servos(); ++i) {
      if (!stage.line(0).whole()) stage.judge->Unheard(i, kNever - seconds(60));
    }
    stage.Tick();
    const double part = stage.Part(0, stage.seen(0).position);
    cut.strayed = std::max(cut.strayed, std::max(part, before) - std::min(before, 0.5));
    // Never beyond the places where it was told to be, and neutral.
    EXPECT_GE(part, 0.45) << bytes;
    EXPECT_LE(part, 0.86) << bytes;
  }
  cut.times = watch.times(0);
  for (const sim::Event& event : stage.line(0).bus().trace().events()) {
    if (event.kind == sim::EventKind::kWatchdog && !cut.own_means) cut.own_means = event.at;
  }
  EXPECT_EQ(stage.judge->Report(), "") << Name(options.lines[0].kind) << ' ' << bytes;
  return cut;
}

// At every byte of so many: several ticks of motion, questions among them.
constexpr std::size_t kBytes = 120;

struct Spread {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::size_t count = 0;

  void Add(const std::optional<Time>& at, Time start) {
    if (!at) return;
    ++count;
    least = std::min(least, Ms(*at - start));
    most = std::max(most, Ms(*at - start));
  }
  std::string Text() const {
    if (count == 0) return "-";
    return std::to_string(std::lround(least)) + " to " + std::to_string(std::lround(most)) + " ms";
  }
};

class CutAtEveryByte : public testing::Test {
 protected:
  static constexpr Duration kLong = seconds(9);

  // At every byte of some ticks.
  void Measure(const StageOptions& options, const char* what) {
    for (std::size_t bytes = 0; bytes < kBytes; ++bytes) {
      const Cut cut = CutAfter(options, bytes, kLong);
      own_means.Add(cut.own_means, cut.start);
      left.Add(cut.times.left, cut.start);
      neutral.Add(cut.times.neutral, cut.start);
      limp.Add(cut.times.limp, cut.start);
    }
    std::printf("| %-34s | %-15s | %-15s | %-15s | %-15s |\n", what, own_means.Text().c_str(),
                left.Text().c_str(), neutral.Text().c_str(), limp.Text().c_str());
  }
  Spread own_means, left, neutral, limp;
};

TEST_F(CutAtEveryByte, AMaestroGoesHomeByItsOwnTimeout) {
  Measure(OneKind(Kind::kMaestro, 1), "maestro, timeout 500 ms, home off");
  EXPECT_EQ(limp.count, kBytes);
  EXPECT_GE(limp.least, 500);
  EXPECT_LE(limp.most, 500 + 60);  // a tick, and two frames without a pulse
  EXPECT_EQ(neutral.count, 0U);
}

TEST_F(CutAtEveryByte, AMaestroWithAHomeGoesThereAndStays) {
  StageOptions options = OneKind(Kind::kMaestro, 1);
  options.lines[0].home_neutral = true;
  Measure(options, "maestro, timeout 500 ms, home 1500");
  EXPECT_EQ(neutral.count, kBytes);
  EXPECT_LE(neutral.most, 700);
  EXPECT_EQ(limp.count, 0U) << "it keeps its pulses";
}

TEST_F(CutAtEveryByte, AMaestroWithoutATimeoutHoldsForEver) {
  StageOptions options = OneKind(Kind::kMaestro, 1);
  options.lines[0].serial_timeout = {};
  Measure(options, "maestro as from the works");
  EXPECT_EQ(limp.count, 0U);
}

TEST_F(CutAtEveryByte, AReceiverHoldsEasesAndLetsGoByItsOwnClock) {
  Measure(OneKind(Kind::kReceiver, 1), "receiver");
  EXPECT_EQ(neutral.count, kBytes);
  EXPECT_EQ(limp.count, kBytes);
  EXPECT_GE(left.least, 400);
  EXPECT_GE(neutral.least, 1500);
  EXPECT_LE(neutral.most, 400 + 1500 + 100);
  EXPECT_GE(limp.least, 6900);
  EXPECT_LE(limp.most, 6900 + 120);
}

TEST_F(CutAtEveryByte, ADynamixelIsStoppedByItsWatchdogAndHolds) {
  Measure(OneKind(Kind::kDynamixel, 1), "dynamixel, watchdog 500 ms");
  EXPECT_EQ(own_means.count, kBytes);
  EXPECT_GE(own_means.least, 490);
  EXPECT_LE(own_means.most, 520);
  EXPECT_EQ(limp.count, 0U);
  EXPECT_EQ(left.count, 0U);
}

TEST_F(CutAtEveryByte, AFeetechHoldsForEver) {
  Measure(OneKind(Kind::kSts, 1), "sts: nothing of its own");
  EXPECT_EQ(limp.count, 0U);
  EXPECT_EQ(left.count, 0U);
}

TEST_F(CutAtEveryByte, AnScsHoldsForEver) {
  Measure(OneKind(Kind::kScs, 1), "scs: nothing of its own");
  EXPECT_EQ(limp.count, 0U);
  EXPECT_EQ(left.count, 0U);
}

TEST(WhenTheCableIsCut, OnlyTheSupplyEndsTheTorqueOfAFeetech) {
  Stage stage(OneKind(Kind::kSts, 1));
  Settle(stage);
  stage.line(0).CutAfter(0);
  stage.judge->Unheard(0, kNever - seconds(60));
  stage.Run(seconds(60));
  EXPECT_TRUE(stage.seen(0).torque);
  stage.line(0).bus().Inject({.kind = sim::FaultKind::kVanish, .at = stage.now() - Time{}});
  stage.Run(seconds(2));
  EXPECT_FALSE(stage.seen(0).torque);
}

// Nothing comes back, and the servos may still hear: nobody can see their heat, so they are let go.
TEST(WhenNothingComesBack, TheHostLetsGoOfServosThatItCannotSee) {
  std::printf("| bus        | limp after nothing came back for |\n");
  Stage stage(EveryKind(2));
  Settle(stage);
  for (const auto& line : stage.lines()) line->silent = true;
  const Time start = stage.now();
  const Stopwatch watch(stage);
  stage.Run(seconds(10));
  for (std::size_t i = 0; i < stage.servos(); i += 2) {
    const Kind kind = stage.line_of(i).options().kind;
    const auto limp = watch.times(i).limp;
    std::printf("| %-10s | %s |\n", Name(kind), Since(limp, start).c_str());
    ASSERT_TRUE(limp) << Name(kind);
    // A receiver says something of its own accord once a second, five are waited for.
    EXPECT_LE(*limp - start, kind == Kind::kReceiver ? milliseconds(7000) : milliseconds(1500));
    EXPECT_EQ(stage.head.feedback(i).state, bus::ServoState::kAbsent);
  }
}

// What the host does about a bus that does not answer any more: the others go on, and when the
// cable is back, so is the servo, slowly.
TEST(WhenTheCableIsBack, EveryServoComesBackAndNothingElseWasDisturbed) {
  for (std::size_t bus = 0; bus < kKinds.size(); ++bus) {
    Stage stage(EveryKind(2));
    Settle(stage);
    stage.line(bus).CutAfter(7);
    for (const Time end = stage.now() + seconds(9); stage.now() < end;) {
      for (std::size_t i = 0; i < stage.servos(); ++i) {
        if (&stage.line_of(i) == &stage.line(bus))
          stage.judge->Unheard(i, stage.now() + seconds(3));
      }
      stage.Tick();
    }
    for (std::size_t i = 0; i < stage.servos(); ++i) {
      if (&stage.line_of(i) == &stage.line(bus)) continue;
      EXPECT_TRUE(stage.seen(i).torque) << Name(kKinds[bus]) << ' ' << i;
    }
    stage.line(bus).Mend();
    const Time mended = stage.now();
    EXPECT_TRUE(stage.RunUntil([&] { return stage.AllOn(); }, seconds(6))) << Name(kKinds[bus]);
    std::printf("| %-10s | back after %4.0f ms |\n", Name(kKinds[bus]), Ms(stage.now() - mended));
    stage.Run(seconds(4));
    EXPECT_EQ(stage.judge->Report(), "") << Name(kKinds[bus]);
    for (std::size_t i = 0; i < stage.servos(); ++i) {
      EXPECT_NEAR(stage.Part(i, stage.seen(i).position), 0.8, 0.03) << i;
    }
  }
}

}  // namespace
}  // namespace facewire::stage
