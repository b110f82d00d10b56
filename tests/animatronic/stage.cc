#include "tests/animatronic/stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;

// The one that yields stays below the other by a tenth of the way, in each servo's own unit.
servo::Linkage RuleBetween(const servo::ServoRig& rig, std::size_t yields, std::size_t other) {
  const servo::Servo& a = rig.servos[yields];
  const servo::Servo& b = rig.servos[other];
  servo::Linkage rule;
  rule.name = *ShortName::From("rule" + std::to_string(rig.linkages.size()));
  rule.yields = static_cast<std::uint8_t>(yields);
  rule.other = static_cast<std::uint8_t>(other);
  rule.relation = servo::Relation::kAtMost;
  rule.gain = (a.max - a.min) / (b.max - b.min);
  rule.offset = a.min - rule.gain * b.min + 0.1F * (a.max - a.min);
  return rule;
}

}  // namespace

StageOptions EveryKind(std::size_t servos_each) {
  StageOptions options;
  for (const Kind kind : kKinds) options.lines.push_back({.kind = kind, .servos = servos_each});
  return options;
}

StageOptions OneKind(Kind kind, std::size_t servos) {
  StageOptions options;
  options.lines.push_back({.kind = kind, .servos = servos});
  return options;
}

Stage::Stage(const StageOptions& options)
    : performer([](std::size_t, double) { return 0.5; }), random_(options.seed) {
  rig_.contract = options.contract;
  rig_.following = options.following;
  std::vector<Wire> wires;
  for (const LineOptions& line : options.lines) {
    std::vector<servo::Servo> here;
    for (std::size_t i = 0; i < line.servos; ++i) {
      const std::size_t number = rig_.servos.size();
      // Channels begin at 0, ids at 1.
      here.push_back(
          ServoOf(line.kind, number, static_cast<std::uint8_t>(IsPulses(line.kind) ? i : i + 1)));
      here.back().bus = *ShortName::From("bus" + std::to_string(lines_.size()));
      (void)rig_.servos.try_push(here.back());
      Channel channel;
      channel.name = here.back().sources[0].channel;
      (void)channels_.channels.try_push(channel);
      places_.push_back({lines_.size(), i});
    }
    lines_.push_back(std::make_unique<Line>(line, options.contract, here));
    for (std::size_t i = 0; i < line.servos; ++i) wires.push_back(lines_.back()->wire(i));
  }
  if (options.linked) {
    for (std::size_t i = 0; i + 1 < rig_.servos.size(); ++i) {
      // From bus to bus, and between the first two of each.
      const bool first = places_[i].index == 0;
      const bool last = places_[i].bus != places_[i + 1].bus;
      if (first || last) (void)rig_.linkages.try_push(RuleBetween(rig_, i + 1, i));
    }
  }
  Configure();
  judge = std::make_unique<Judge>(rig_, wires);
  seen_.resize(servos());
  for (const auto& line : lines_) line->bus().Advance(world_);
}

void Stage::Configure() {
  std::vector<animatronic::Attachment> attachments(lines_.size());
  for (std::size_t i = 0; i < servos(); ++i) {
    (void)attachments[places_[i].bus].servos.try_push(static_cast<std::uint8_t>(i));
  }
  for (std::size_t bus = 0; bus < lines_.size(); ++bus) {
    attachments[bus].driver = &lines_[bus]->driver();
    attachments[bus].period = lines_[bus]->options().period;
  }
  if (!head.Configure(rig_, attachments) || !mapper_.Configure(rig_, channels_)) {
    throw std::logic_error("this rig is no rig");
  }
}

void Stage::Restart() {
  for (const auto& line : lines_) line->StartDriver();
  Configure();
}

double Stage::Part(std::size_t servo, double position) const {
  const servo::Servo& limits = rig_.servos[servo];
  return (position - limits.min) / (double{limits.max} - limits.min);
}

// The camera's frames, which reach the host a little unevenly.
void Stage::Perform() {
  if (world_ < frame_arrives_) return;
  const Time captured = frame_;
  frame_ = std::max(frame_ + kFrame, world_ - kFrame);
  const double late_us = late_frames ? random_.Between(0, 12'000) : 0;
  frame_arrives_ = frame_ + Duration(static_cast<std::int64_t>(late_us));
  if (!performs) return;
  RigPose pose;
  pose.captured = captured + skew;
  pose.count = servos();
  const double t_s = std::chrono::duration<double>(captured.time_since_epoch()).count();
  for (std::size_t i = 0; i < servos(); ++i) {
    pose.values[i] = static_cast<float>(performer(i, t_s));
    if (!std::isnan(pose.values[i])) judge->Wished(i, world_);
  }
  head.Take(mapper_.Map(pose), host_now());
}

void Stage::Tick() {
  const Time now = host_now();
  for (std::size_t i = 0; i < lines_.size(); ++i) head.Receive(i, lines_[i]->ToHost(), now);
  Perform();
  head.Update(now);
  // As Motion sees it: its time does not go back.
  const Duration passed = ticked_ ? now - *ticked_ : Duration{};
  const bool back = passed < Duration{} && passed >= -servo::Motion::kLongestTick;
  judge->Told(world_, std::max(Duration{}, passed), head.commands());
  if (!back) ticked_ = now;
  for (std::size_t i = 0; i < lines_.size(); ++i) lines_[i]->ToServos(head.Bytes(i, now), world_);
  Stall(head.period());
}

void Stage::Stall(Duration time) {
  for (const Time end = world_ + time; world_ < end;) Millisecond();
}

void Stage::Millisecond() {
  world_ += milliseconds(1);
  for (const auto& line : lines_) line->bus().Advance(world_);
  for (std::size_t i = 0; i < servos(); ++i) seen_[i] = line_of(i).Look(index_of(i));
  judge->Look(world_, seen_);
  if (on_look) on_look();
}

void Stage::Run(Duration time) {
  for (const Time end = world_ + time; world_ < end;) Tick();
}

bool Stage::RunUntil(const std::function<bool()>& done, Duration most) {
  for (const Time end = world_ + most; world_ < end && !done();) Tick();
  return done();
}

bool Stage::AllOn() {
  for (std::size_t i = 0; i < servos(); ++i) {
    if (head.feedback(i).state != bus::ServoState::kOn || !seen_[i].torque) return false;
  }
  return true;
}

}  // namespace facewire::stage
