#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/animatronic/performers.h"
#include "tests/animatronic/stage.h"

// An hour in which everything goes wrong, on all buses at once; and nothing that must not happen.

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

// An hour would be too long for a build with sanitizers or on an emulated processor.
constexpr int kMinutes = FACEWIRE_SIM_MINUTES;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// How long after a time of bad lines a driver may take until everybody has been told everything
// again: five lost replies, a look, a try after each `retry`.
constexpr Duration kRecovers = milliseconds(2500);

// What happens when, by chance. Each trouble begins by itself about so many times a minute.
class Troubles {
 public:
  Troubles(Stage& stage, std::uint64_t seed) : stage_(stage), random_(seed) {
    stage_.performer = [this](std::size_t servo, double t_s) { return Wish(servo, t_s); };
    for (std::size_t bus = 0; bus < stage_.lines().size(); ++bus) InjectFaults(bus, seed + bus);
  }

  // Before a tick.
  void Tick() {
    for (const Trouble& trouble : kTroubles) {
      if (!random_.Chance(trouble.per_minute / 6000)) continue;
      ++happened[trouble.name];
      (this->*trouble.begin)();
    }
    for (auto end = ends_.begin(); end != ends_.end() && end->first <= stage_.now();) {
      end->second();
      end = ends_.erase(end);
    }
    Excuse();
  }

  std::map<std::string, int> happened;

 private:
  struct Trouble {
    const char* name;
    double per_minute;
    void (Troubles::*begin)();
  };
  static const std::vector<Trouble> kTroubles;

  void Until(double longest_s, std::function<void()> end) {
    const auto lasts = Duration(static_cast<std::int64_t>(1e6 * random_.Between(0.02, longest_s)));
    ends_.emplace(stage_.now() + lasts, std::move(end));
  }
  std::size_t SomeBus() { return random_.Next() % stage_.lines().size(); }
  std::size_t SomeServo() { return random_.Next() % stage_.servos(); }

  double Wish(std::size_t servo, double t_s) {
    if (servo == blind_) return kNan;
    if (servo == wild_) return random_.Between(-1, 2);
    const double wish = Moving(servo, t_s) + leap_;
    return random_.Chance(1e-3) ? std::numeric_limits<double>::infinity() : wish;
  }

  void LoseWishes() {
    stage_.performs = false;
    Until(12, [this] { stage_.performs = true; });
  }
  void WishNothing() {
    blind_ = SomeServo();
    Until(12, [this] { blind_ = kNobody; });
  }
  void WishAnything() {
    wild_ = SomeServo();
    Until(3, [this] { wild_ = kNobody; });
  }
  void Leap() { leap_ = random_.Between(-0.4, 0.4); }
  void Stop() {
    if (stage_.head.stopped()) return;
    stage_.head.Stop();
    stage_.judge->Stopped(stage_.now());
    Until(4, [this] {
      stage_.head.Release();
      stage_.judge->Released();
    });
  }
  void Cut() {
    const std::size_t bus = SomeBus();
    Line& line = stage_.line(bus);
    if (!line.whole()) return;
    line.CutAfter(random_.Next() % 60);
    Until(3, [&line] { line.Mend(); });
  }
  void LosePort() {
    const std::size_t bus = SomeBus();
    Line& line = stage_.line(bus);
    if (!line.whole()) return;
    line.CutAfter(0);
    Until(3, [this, &line, bus] {
      line.Mend();
      stage_.head.Restart(bus);
    });
  }
  void GoDeaf() {
    Line& line = stage_.line(SomeBus());
    line.deaf = true;
    Until(2, [&line] { line.deaf = false; });
  }
  void GoSilent() {
    Line& line = stage_.line(SomeBus());
    line.silent = true;
    Until(2, [&line] { line.silent = false; });
  }
  void BadLine() {
    Line& line = stage_.line(SomeBus());
    // A checksum of eight bits passes one forgery in 256, and a Maestro without CRC every one:
    // there, bytes are lost and come from nowhere, but are not changed (README.md).
    const Kind kind = line.options().kind;
    const bool strong = kind == Kind::kDynamixel || kind == Kind::kReceiver;
    const double rate = random_.Between(1e-4, 1e-2);
    line.bus().line_faults() = {.lose = rate,
                                .flip = strong ? rate : 0,
                                .duplicate = strong ? rate : 0,
                                .late = 10 * rate,
                                .late_ms = 30,
                                .noise_per_s = 500 * rate};
    Until(4, [&line] { line.bus().line_faults() = {}; });
  }
  void Stall() { stalled_ = Duration(static_cast<std::int64_t>(random_.Between(2e3, 2e6))); }
  void ClockGoesOn() {
    // By less than Motion::kLongestTick it would be a late tick, for all that the host can know.
    stage_.skew += Duration(static_cast<std::int64_t>(random_.Between(1e5, 20e6)));
  }
  void ClockGoesBack() {
    const auto back = Duration(static_cast<std::int64_t>(random_.Between(1e3, 9e4)));
    stage_.skew -= back;
    stage_.judge->Delayed(back);
  }
  void Hand() {
    hand_ = SomeServo();
    hand_at_ = random_.Between(-0.2, 1.2);
    Until(3, [this] { hand_ = kNobody; });
  }
  void Reboot() { (void)stage_.head.Reboot(SomeServo()); }

  void InjectFaults(std::size_t bus, std::uint64_t seed) {
    Line& line = stage_.line(bus);
    const servo::Servo servo = ServoOf(line.options().kind, 0, 1);
    faults_.push_back(
        sim::RandomFaults(seed, line.bus().servos(), minutes(kMinutes), 6, servo.min, servo.max));
    for (const sim::Fault& fault : faults_.back()) line.bus().Inject(fault);
  }

  // Who cannot hear, or be heard, is told to the judge.
  void Excuse() {
    const bool stalled = stalled_ > Duration::zero();
    const Time awake = stage_.now() + stalled_;
    for (std::size_t i = 0; stalled && i < stage_.servos(); ++i) stage_.judge->Unheard(i, awake);
    stage_.Stall(std::exchange(stalled_, {}));
    for (std::size_t i = 0; i < stage_.servos(); ++i) {
      Line& line = stage_.line_of(i);
      const sim::LineFaults& faults = line.bus().line_faults();
      const bool bad = faults.lose > 0 || !line.whole();
      if (bad) stage_.judge->Unheard(i, stage_.now() + kRecovers);
    }
    for (std::size_t bus = 0; bus < faults_.size(); ++bus) {
      for (const sim::Fault& fault : faults_[bus]) {
        const Time began = Time(seconds(1)) + fault.at;
        if (began > stage_.now()) break;
        if (began + fault.lasts < stage_.now()) continue;
        if (fault.kind != sim::FaultKind::kMute && fault.kind != sim::FaultKind::kVanish) continue;
        for (std::size_t i = 0; i < stage_.servos(); ++i) {
          if (&stage_.line_of(i) != &stage_.line(bus) || stage_.index_of(i) != fault.servo)
            continue;
          stage_.judge->Unheard(i, stage_.now() + kRecovers);
        }
      }
    }
    if (hand_ == kNobody) return;
    const servo::Servo& servo = stage_.rig().servos[hand_];
    stage_.head.SetManual(hand_, static_cast<float>(servo.min + hand_at_ * (servo.max - servo.min)),
                          stage_.host_now());
    stage_.judge->Wished(hand_, stage_.now());
  }

  static constexpr std::size_t kNobody = 1000;

  Stage& stage_;
  sim::Random random_;
  std::multimap<Time, std::function<void()>> ends_;
  std::vector<std::vector<sim::Fault>> faults_;
  std::size_t blind_ = kNobody, wild_ = kNobody, hand_ = kNobody;
  double leap_ = 0, hand_at_ = 0;
  Duration stalled_{};
};

const std::vector<Troubles::Trouble> Troubles::kTroubles = {
    {"no wishes for a while", 1, &Troubles::LoseWishes},
    {"no wish for one servo", 1, &Troubles::WishNothing},
    {"wild wishes for one servo", 1, &Troubles::WishAnything},
    {"all wishes leap", 3, &Troubles::Leap},
    {"emergency stop", 1, &Troubles::Stop},
    {"cable cut", 1, &Troubles::Cut},
    {"port lost and opened again", 0.5, &Troubles::LosePort},
    {"nothing gets to a bus", 0.5, &Troubles::GoDeaf},
    {"nothing gets back", 0.5, &Troubles::GoSilent},
    {"bad line", 2, &Troubles::BadLine},
    {"host stalls", 1, &Troubles::Stall},
    {"clock goes on by itself", 0.3, &Troubles::ClockGoesOn},
    {"clock goes back", 0.5, &Troubles::ClockGoesBack},
    {"a hand", 1, &Troubles::Hand},
    {"reboot of a servo", 0.5, &Troubles::Reboot},
};

struct Hour {
  std::uint64_t seed;
  bool mini;  // a Mini Maestro with CRC instead of a Micro without
  std::array<int, kKinds.size()> periods_ms;
};
class AnHourOfFaults : public testing::TestWithParam<Hour> {};

TEST_P(AnHourOfFaults, BreaksNoRuleOnAnyBus) {
  const std::clock_t began = std::clock();
  StageOptions options = EveryKind(3);
  options.linked = true;
  for (std::size_t bus = 0; bus < kKinds.size(); ++bus) {
    options.lines[bus].period = milliseconds(GetParam().periods_ms[bus]);
  }
  options.lines[0].multi_target = options.lines[0].crc = GetParam().mini;
  options.contract.limp = seconds(2);
  Stage stage(options);
  Troubles troubles(stage, GetParam().seed);
  std::vector<std::size_t> settings;  // that the stage itself wrote
  for (const auto& line : stage.lines()) {
    settings.push_back(line->bus().trace().Count(sim::EventKind::kEepromWrite));
  }
  for (const Time end = stage.now() + minutes(kMinutes); stage.now() < end;) {
    troubles.Tick();
    stage.Tick();
  }
  EXPECT_EQ(stage.judge->Report(), "");

  std::printf("%d simulated minutes took %.1f s of processor time\n", kMinutes,
              static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
  for (const auto& [what, count] : troubles.happened) std::printf("%6d  %s\n", count, what.c_str());
  std::printf("%18s", "");
  for (const auto& line : stage.lines()) std::printf(" %10s", Name(line->options().kind));
  std::printf("\n");
  for (std::size_t kind = 0; kind < sim::kEventKinds; ++kind) {
    std::printf("%18s", sim::Name(static_cast<sim::EventKind>(kind)));
    for (const auto& line : stage.lines()) {
      std::printf(" %10zu", line->bus().trace().Count(static_cast<sim::EventKind>(kind)));
    }
    std::printf("\n");
  }
  std::printf("goals forged by a damaged packet with a good sum: %zu\n", stage.judge->forged());
  std::printf("looked at servos with torque %.1f million times\n",
              static_cast<double>(stage.judge->looks()) * 1e-6);
  for (std::size_t bus = 0; bus < settings.size(); ++bus) {
    const sim::Trace& trace = stage.line(bus).bus().trace();
    EXPECT_EQ(trace.Count(sim::EventKind::kEepromWrite), settings[bus]);
    EXPECT_EQ(trace.Count(sim::EventKind::kFactoryReset), 0U);
  }
  EXPECT_LE(stage.judge->forged(), static_cast<std::size_t>(kMinutes) / 2 + 1);
  EXPECT_GT(stage.judge->looks(), static_cast<std::uint64_t>(kMinutes) * 60 * 1000 * 12 / 3);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AnHourOfFaults,
                         testing::Values(Hour{1, false, {10, 10, 10, 10, 10}},
                                         Hour{4, true, {10, 10, 10, 10, 10}},
                                         Hour{8, false, {20, 10, 5, 10, 20}}),
                         [](const auto& hour) { return "Seed" + std::to_string(hour.param.seed); });

}  // namespace
}  // namespace facewire::stage
