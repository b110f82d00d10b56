#include "core/animatronic/animatronic.h"

#include <algorithm>
#include <functional>

namespace facewire::animatronic {
namespace {

// By how much a servo may be faster by itself than it is told to be: it has to keep up with every
// step, and a goal that was lost must not come back as a leap.
constexpr float kHeadroom = 1.25F;

}  // namespace

bus::ServoConfig ConfigOf(const servo::Servo& servo, const bus::GuardConfig& guard) noexcept {
  return {.id = servo.id,
          .min = servo.min,
          .max = servo.max,
          .neutral = servo.neutral,
          .arrive_speed_per_s = servo.crawl_speed_per_s,
          .arrive_acceleration_per_s2 =
              servo.max_acceleration_per_s2 * servo.crawl_speed_per_s / servo.max_speed_per_s,
          .top_speed_per_s = kHeadroom * servo.max_speed_per_s,
          .guard = guard};
}

Result<> Animatronic::Configure(const servo::ServoRig& rig,
                                std::span<const Attachment> buses) noexcept {
  places_.clear();
  buses_.clear();
  commands_ = &kNone;
  period_ = {};
  holding_stop_ = over_ = false;
  std::array<servo::Actuator, kMaxServos> actuators{};
  const std::span mine = std::span(actuators).first(rig.servos.size());
  (void)places_.try_resize(mine.size());  // of the same capacity
  Result<> ok = Attach(buses, mine);
  if (ok) ok = motion_.Configure(rig, mine);
  if (!ok) {
    places_.clear();
    buses_.clear();
  }
  return ok;
}

Result<> Animatronic::Attach(std::span<const Attachment> buses,
                             std::span<servo::Actuator> actuators) noexcept {
  std::array<bool, kMaxServos> placed{};
  for (const Attachment& wiring : buses) {
    if (wiring.driver == nullptr || wiring.period <= Duration::zero() ||
        wiring.driver->feedback().size() != wiring.servos.size() ||
        !buses_.try_push({.wiring = wiring})) {
      return Errc::kInvalidArgument;
    }
    period_ = period_ == Duration::zero() ? wiring.period : std::min(period_, wiring.period);
    const bus::BusTraits traits = wiring.driver->traits();
    for (std::size_t i = 0; i < wiring.servos.size(); ++i) {
      const std::size_t servo = wiring.servos[i];
      if (servo >= actuators.size() || placed[servo]) return Errc::kInvalidArgument;
      placed[servo] = true;
      places_[servo] = {.bus = buses_.size() - 1, .index = i};
      actuators[servo] = {.step = traits.step, .reads_back = traits.reads_back};
    }
  }
  const bool all = std::all_of(placed.begin(), placed.begin() + actuators.size(), std::identity{});
  return all ? Result<>{} : Result<>(Errc::kInvalidArgument);
}

void Animatronic::Stop() noexcept {
  if (stopped()) return;
  motion_.Stop();
  holding_stop_ = true;
}

void Animatronic::LetGo() noexcept {
  over_ = true;
  for (Line& line : buses_) line.let_go = true;
}

void Animatronic::Receive(std::size_t bus, std::span<const std::byte> bytes, Time now) noexcept {
  buses_[bus].wiring.driver->Receive(bytes, now);
}

void Animatronic::Update(Time now) noexcept {
  TakeFeedback(now);
  commands_ = &motion_.Tick(now);
  if (!stopped()) holding_stop_ = false;
  if (!holding_stop_ || AnyTorque()) return;
  holding_stop_ = false;
  for (Line& line : buses_) line.let_go = true;
}

void Animatronic::TakeFeedback(Time now) noexcept {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    Place& place = places_[i];
    const bus::ServoFeedback& said = feedback(i);
    motion_.SetHealth(i, said.factor);
    if (!said.position || said.position_read == place.read) continue;
    place.read = said.position_read;
    motion_.SetReading(i, *said.position, now);
  }
}

bool Animatronic::AnyTorque() const noexcept {
  return std::any_of(commands_->servos.begin(), commands_->servos.begin() + commands_->count,
                     [](const servo::Command& command) { return command.torque; });
}

std::span<const std::byte> Animatronic::Bytes(std::size_t bus, Time now) noexcept {
  Line& line = buses_[bus];
  bus::ServoBus& driver = *line.wiring.driver;
  if (line.let_go) {
    line.let_go = false;
    return driver.Release(now);
  }
  // A tick may come a little before its time: it stands for the nearest turn.
  if (line.next && now + period_ / 2 < *line.next) return {};
  // Absolute, so that a late tick does not move the next; after a gap there is nothing to make up.
  line.next = line.next.value_or(now) + line.wiring.period;
  if (*line.next <= now) line.next = now + line.wiring.period;
  const auto& servos = line.wiring.servos;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    const servo::Command& command = commands_->servos[servos[i]];
    told_[i] = {
        .position = command.position, .torque = command.torque && !over_, .stop = stopped()};
  }
  return driver.Tick(now, {told_.data(), servos.size()});
}

bool Animatronic::Limp() const noexcept {
  return std::ranges::all_of(buses_, [](const Line& line) {
    return std::ranges::all_of(line.wiring.driver->feedback(), [](const auto& said) {
      return said.state == bus::ServoState::kAbsent || !said.torque;
    });
  });
}

void Animatronic::Restart(std::size_t bus) noexcept { buses_[bus].wiring.driver->Restart(); }

Result<> Animatronic::Reboot(std::size_t servo) noexcept {
  if (servo >= places_.size()) return Errc::kOutOfRange;
  return buses_[places_[servo].bus].wiring.driver->Reboot(places_[servo].index);
}

const bus::ServoFeedback& Animatronic::feedback(std::size_t servo) const noexcept {
  const Place& place = places_[servo];
  return buses_[place.bus].wiring.driver->feedback()[place.index];
}

}  // namespace facewire::animatronic
