#include "core/servo/motion.h"

#include <algorithm>
#include <cmath>

namespace facewire::servo {
namespace {

// Longer than all times of a contract together.
constexpr Duration kForever = std::chrono::hours(24 * 30);

}  // namespace

Result<> Motion::Configure(const ServoRig& rig, std::span<const Actuator> actuators) noexcept {
  channels_.clear();
  commands_ = Commands{};
  last_.reset();
  captured_.reset();
  clock_ = ticked_ = Duration::zero();
  stopped_ = false;
  if (FindFlaw(rig)) return Errc::kOutOfRange;
  if (actuators.size() < rig.servos.size()) return Errc::kInvalidArgument;
  for (std::size_t i = 0; i < rig.servos.size(); ++i) {
    const Servo& servo = rig.servos[i];
    const float step = actuators[i].step;
    if (!std::isfinite(step) || step <= 0) return Errc::kInvalidArgument;
    if (!axes_[i].Configure(servo, step)) return Errc::kOutOfRange;
  }
  for (std::size_t i = 0; i < rig.servos.size(); ++i) {
    const Servo& servo = rig.servos[i];
    Channel channel;
    channel.actuator = actuators[i];
    channel.limp_after = servo.limp_after;
    channel.range = double{servo.max} - servo.min;
    channel.aim.Configure(servo, rig, actuators[i].step);
    (void)channels_.try_push(channel);
    commands_.servos[i].position = static_cast<float>(axes_[i].command());
  }
  commands_.count = channels_.size();
  stop_torque_ = rig.contract.stop_torque;
  linkages_.Configure(rig, {axes_.data(), channels_.size()});
  return {};
}

void Motion::Advance(Time now) noexcept {
  const Duration passed = last_ ? Between(*last_, now) : Duration::zero();
  if (last_ && passed <= Duration::zero() && passed >= -kLongestTick) return;
  last_ = now;
  clock_ += std::clamp(passed, Duration::zero(), kForever);
}

void Motion::Take(const Wishes& wishes, Time now) noexcept {
  Advance(now);
  const Duration since = captured_ ? Between(*captured_, wishes.captured) : Duration::zero();
  const Duration interval = since > Duration::zero() ? since : Follower::kUsual;
  captured_ = wishes.captured;
  for (std::size_t i = 0; i < std::min(wishes.count, channels_.size()); ++i) {
    if (std::isnan(wishes.positions[i])) continue;
    channels_[i].aim.TakeWish(axes_[i].Inside(wishes.positions[i]), clock_, interval);
  }
}

void Motion::SetManual(std::size_t servo, float position, Time now) noexcept {
  Advance(now);
  if (servo >= channels_.size() || std::isnan(position)) return;
  channels_[servo].aim.TakeManual(axes_[servo].Inside(position), clock_);
}

void Motion::SetReading(std::size_t servo, float position, Time now) noexcept {
  Advance(now);
  if (servo >= channels_.size() || std::isnan(position)) return;
  channels_[servo].reading = axes_[servo].Inside(position);
  channels_[servo].read = clock_;
}

void Motion::SetHealth(std::size_t servo, float part) noexcept {
  if (servo >= channels_.size() || std::isnan(part)) return;
  channels_[servo].health = std::clamp(part, 0.F, 1.F);
}

void Motion::Stop() noexcept {
  if (!stopped_) stopped_at_ = clock_;
  stopped_ = true;
  for (Axis& axis : axes_) axis.Freeze();
}

void Motion::Release() noexcept {
  if (!stopped_) return;
  stopped_ = false;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    channels_[i].idle = false;
    Crawl(i);
  }
}

double Motion::StepSeconds() noexcept {
  const Duration step = clock_ - ticked_;
  ticked_ = clock_;
  if (step <= kLongestTick) return std::chrono::duration<double>(step).count();
  for (Axis& axis : axes_) axis.Freeze();
  return 0;
}

const Commands& Motion::Tick(Time now) noexcept {
  Advance(now);
  const double dt_s = StepSeconds();
  for (std::size_t i = 0; i < channels_.size(); ++i) Decide(i);
  for (const std::size_t i : linkages_.order()) Run(i, dt_s);
  for (std::size_t i = 0; i < channels_.size(); ++i) Report(i);
  return commands_;
}

// What this servo is to do in this tick, apart from moving.
void Motion::Decide(std::size_t i) noexcept {
  Channel& channel = channels_[i];
  channel.activity = channel.aim.Update(clock_);
  const bool alive = IsAlive(channel.activity) && channel.health > 0;
  goals_[i] = alive ? axes_[i].Inside(channel.aim.goal()) : axes_[i].position();
  if (channel.health <= 0) channel.activity = Activity::kHot;
  if (stopped_) {
    channel.activity = Activity::kStopped;
    if (clock_ - stopped_at_ >= stop_torque_) Drop(i);
  }
  if (!alive) Drop(i);
}

void Motion::Drop(std::size_t i) noexcept {
  // What a controller said of a pulse that was still being told is older than the last command.
  if (channels_[i].torque && !channels_[i].actuator.reads_back) channels_[i].read.reset();
  axes_[i].Freeze();
  channels_[i].torque = false;
  channels_[i].idle = false;
}

void Motion::Engage(std::size_t i, bool crawl) noexcept {
  Channel& channel = channels_[i];
  if (channel.read && clock_ - *channel.read <= kFreshReading) {
    const double astray = std::abs(channel.reading - axes_[i].command());
    axes_[i].Place(channel.reading);
    crawl = crawl || astray > kAstray * channel.range;
  } else if (channel.actuator.reads_back) {
    return;
  } else {
    axes_[i].Place(axes_[i].command());
  }
  axes_[i].SetCrawl(false);
  if (crawl) Crawl(i);
  channel.torque = true;
  channel.idle = false;
  channel.moved = clock_;
}

void Motion::Run(std::size_t i, double dt_s) noexcept {
  Channel& channel = channels_[i];
  Axis& axis = axes_[i];
  if (!IsAlive(channel.activity)) return;
  const Span room = linkages_.Room(i, {axes_.data(), channels_.size()});
  const double goal = linkages_.GiveWay(i, {goals_.data(), channels_.size()});
  const double target = std::max(std::min(goal, room.high), room.low);
  if (!channel.torque) {
    if (channel.idle && axis.Rounded(target) == axis.command()) return;
    Engage(i, !channel.idle);  // and moves in the next tick
    return;
  }
  const double before = axis.command();
  axis.SetVigour(channel.health);
  axis.Move(goal, room, dt_s);
  WatchCrawl(i, goal);
  if (axis.command() != before || axis.Rounded(target) != before) channel.moved = clock_;
  if (channel.limp_after > Duration::zero() && clock_ - channel.moved >= channel.limp_after) {
    Drop(i);
    channel.idle = true;
  }
}

void Motion::Crawl(std::size_t i) noexcept {
  axes_[i].SetCrawl(true);
  channels_[i].crawling = clock_;
  channels_[i].crawl_side = 0;
}

// A crawl is over when the servo has met its goal, or the goal has come to meet it.
void Motion::WatchCrawl(std::size_t i, double goal) noexcept {
  Channel& channel = channels_[i];
  if (!axes_[i].crawls()) return;
  const double left = axes_[i].Inside(goal) - axes_[i].position();
  const double side = std::abs(left) <= axes_[i].step() / 2 ? 0 : std::copysign(1, left);
  const bool met = side == 0 || side == -channel.crawl_side;
  if (met && clock_ - channel.crawling >= kLeastCrawl) axes_[i].SetCrawl(false);
  channel.crawl_side = side;
}

void Motion::Report(std::size_t i) noexcept {
  const Channel& channel = channels_[i];
  Command& command = commands_.servos[i];
  const auto position = static_cast<float>(axes_[i].command());
  command.changed = command.position != position || command.torque != channel.torque;
  command.position = position;
  command.torque = channel.torque;
  command.activity = channel.activity;
  if (!IsAlive(channel.activity) || channel.torque) return;
  command.activity = channel.idle ? Activity::kIdle : Activity::kWaiting;
}

}  // namespace facewire::servo
