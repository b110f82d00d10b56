#ifndef FACEWIRE_TESTS_APP_ANIMATRONIC_SIM_RIG_H_
#define FACEWIRE_TESTS_APP_ANIMATRONIC_SIM_RIG_H_

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "app/animatronic/output_thread.h"
#include "app/animatronic/servo_output.h"
#include "hal/fake/fake_clock.h"
#include "tests/app/animatronic/servos.h"
#include "tests/app/animatronic/sim_port.h"
#include "tests/sim/feetech.h"

namespace facewire::app {

// Servos on a simulated Feetech chain, in virtual time: "jaw" and "brow", ids 1 and 2.
class SimRig {
 public:
  SimRig() {
    rig = RigOf({ServoOf("jaw", "chain", 1), ServoOf("brow", "chain", 2)});
    rig.contract.hold = std::chrono::milliseconds(200);
    rig.contract.ease = std::chrono::milliseconds(300);
    rig.contract.limp = std::chrono::milliseconds(400);
  }
  void Build() {
    output.emplace(
        std::vector<ServoBusConfig>{BusOf(BusKind::kFeetech, "chain")}, rig, clock,
        [this](const ServoBusConfig& /*bus*/) { return std::make_unique<SimPort>(end); });
    thread.emplace(*output, clock);
    output->Open();
  }
  // Ticks as the thread would, for so long; both servos are wished to be at `wish`, unless NaN.
  void For(Duration time, float wish = kNoWish) {
    for (const Time end_time = clock.Now() + time; clock.Now() < end_time;) {
      if (wish == wish && ticks % 3 == 0) {
        servo::Wishes wishes;
        wishes.seq = ++seq;
        wishes.captured = clock.Now();
        wishes.count = 2;
        wishes.positions[0] = wishes.positions[1] = wish;
        thread->Hand(wishes);
      }
      Tick();
    }
  }
  void Tick() {
    ++ticks;
    thread->Step();
    clock.Advance(output->period());
  }

  static constexpr float kNoWish = std::numeric_limits<float>::quiet_NaN();

  hal::fake::FakeClock clock{Time{std::chrono::seconds(1000)}};
  servo::ServoRig rig;
  sim::Feetech bus{[] {
    sim::FeetechOptions options;
    options.ids = {1, 2};
    options.poses = {1500, 1500};
    return options;
  }()};
  SimEnd end{.bus = bus, .clock = clock};
  std::optional<ServoOutput> output;
  std::optional<OutputThread> thread;
  std::uint64_t seq = 0;
  int ticks = 0;
};

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_ANIMATRONIC_SIM_RIG_H_
