#ifndef FACEWIRE_TESTS_ANIMATRONIC_STAGE_H_
#define FACEWIRE_TESTS_ANIMATRONIC_STAGE_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/animatronic/animatronic.h"
#include "core/servo/mapper.h"
#include "core/servo/servo_rig.h"
#include "tests/animatronic/judge.h"
#include "tests/animatronic/line.h"
#include "tests/sim/random.h"

namespace facewire::stage {

struct StageOptions {
  std::vector<LineOptions> lines;
  servo::Contract contract;
  servo::Following following;
  // On every bus servo 0 stays above servo 1, and from bus to bus one rule joins their last ones.
  bool linked = false;
  std::uint64_t seed = 1;
};
// One line of each kind, all alike.
StageOptions EveryKind(std::size_t servos_each = 3);
StageOptions OneKind(Kind kind, std::size_t servos = 3);

// A character with servos on several buses in a world of virtual time: a performer, the host
// (Mapper, Animatronic, drivers), cables, buses, servos, and a judge who looks on. The host's clock
// is the world's unless `skew` says otherwise.
class Stage {
 public:
  // Part of its range, 0 to 1, where a servo should be at a time; NaN: no wish.
  using Performer = std::function<double(std::size_t servo, double t_s)>;
  static constexpr Duration kFrame{33'333};

  explicit Stage(const StageOptions& options);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // One tick of the host, and the time until its next one.
  void Tick();
  void Run(Duration time);
  // Until it is true, or the time is over; returns whether.
  bool RunUntil(const std::function<bool()>& done, Duration most);
  // The world goes on, the host does not.
  void Stall(Duration time);
  // The host's program starts anew: nothing is known of before. The buses and servos go on.
  void Restart();
  // All servos have torque and follow.
  bool AllOn();

  Time now() const { return world_; }
  double now_s() const { return std::chrono::duration<double>(world_.time_since_epoch()).count(); }
  Time host_now() const { return world_ + skew; }
  const servo::ServoRig& rig() const { return rig_; }
  std::size_t servos() const { return rig_.servos.size(); }
  std::span<const std::unique_ptr<Line>> lines() const { return lines_; }
  Line& line(std::size_t bus) { return *lines_[bus]; }
  Line& line_of(std::size_t servo) { return *lines_[places_[servo].bus]; }
  std::size_t index_of(std::size_t servo) const { return places_[servo].index; }
  const Seen& seen(std::size_t servo) const { return seen_[servo]; }
  // 0 to 1 of the servo's range, for a position in its unit.
  double Part(std::size_t servo, double position) const;

  // With what the rest of the world wants to do with it.
  Performer performer;
  bool performs = true;           // poses come
  bool late_frames = true;        // up to 12 ms after the camera saw them
  Duration skew{};                // of the host's clock
  std::function<void()> on_look;  // after each millisecond
  std::unique_ptr<Judge> judge;
  animatronic::Animatronic head;

 private:
  struct Place {
    std::size_t bus = 0, index = 0;
  };

  void Configure();
  void Perform();
  void Millisecond();

  servo::ServoRig rig_;
  Rig channels_;
  servo::Mapper mapper_;
  std::vector<std::unique_ptr<Line>> lines_;
  std::vector<Place> places_;
  std::vector<Seen> seen_;
  sim::Random random_;
  Time world_{std::chrono::seconds(1)};
  Time frame_{std::chrono::seconds(1)};  // the next one
  Time frame_arrives_{std::chrono::seconds(1)};
  std::optional<Time> ticked_;  // by the host's clock
};

}  // namespace facewire::stage

#endif  // FACEWIRE_TESTS_ANIMATRONIC_STAGE_H_
