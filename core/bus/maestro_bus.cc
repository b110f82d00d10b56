#include "core/bus/maestro_bus.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace facewire::bus {
namespace {

namespace maestro = wire::maestro;

constexpr float kShortestUs = 64;  // what a Maestro can be told to send
constexpr float kLongestUs = 4080;
// A board that ended the pulses by itself had a reason; the motion then starts anew.
constexpr Duration kLetGo = std::chrono::milliseconds(500);
// A pulse differs from its target while a speed limit of the board's own is at work.
constexpr Duration kSettled = std::chrono::milliseconds(1000);

bool Due(const std::optional<Time>& last, Duration interval, Time now) noexcept {
  return !last || Between(*last, now) >= interval;
}

}  // namespace

Result<> MaestroBus::Configure(const MaestroConfig& config) noexcept {
  const auto& servos = config.bus.servos;
  if (servos.empty() || servos.size() > maestro::kMaxChannels || config.bus.baud < 300 ||
      !(config.bus.feedback_share >= 0.01F) || !(config.bus.feedback_share <= 0.9F) ||
      config.bus.reply_timeout <= Duration::zero() || config.bus.refresh <= Duration::zero() ||
      config.bus.retry <= Duration::zero() || config.bus.torque_interval < Duration::zero() ||
      config.bus.gone_after == 0 || config.line.device > 127) {
    return Errc::kOutOfRange;
  }
  for (std::size_t i = 0; i < servos.size(); ++i) {
    const ServoConfig& servo = servos[i];
    if (servo.id >= maestro::kMaxChannels || !(servo.min >= kShortestUs) ||
        !(servo.max <= kLongestUs) ||
        std::ceil(servo.min * maestro::kStepsPerMicrosecond) >
            std::floor(servo.max * maestro::kStepsPerMicrosecond)) {
      return Errc::kOutOfRange;
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (servos[j].id == servo.id) return Errc::kOutOfRange;
    }
  }
  config_ = config;
  encoder_ = maestro::Encoder(config.line);
  status_ = {};
  channels_.clear();
  feedback_.clear();
  (void)channels_.try_resize(servos.size());  // of the same capacity
  (void)feedback_.try_resize(servos.size());
  for (std::size_t i = 0; i < servos.size(); ++i) {
    channels_[i].low =
        static_cast<std::uint16_t>(std::ceil(servos[i].min * maestro::kStepsPerMicrosecond));
    channels_[i].high =
        static_cast<std::uint16_t>(std::floor(servos[i].max * maestro::kStepsPerMicrosecond));
  }
  Restart();
  return {};
}

void MaestroBus::Restart() noexcept {
  for (Channel& c : channels_) {
    c.goal.reset();
    c.wants = false;
    c.sent = 0;
    c.sent_at.reset();
    c.changed_at.reset();
    c.let_go_at.reset();
    c.pulsing = c.seen = false;
  }
  SetAll(ServoState::kAbsent);
  reader_.Forget();
  stage_ = Stage::kResync;
  turn_ = 0;
  lost_in_row_ = 0;
  knocked_ = false;
  deadline_.reset();
  quiet_until_.reset();
  torque_at_.reset();
  status_.findings.clear();
  status_.state = channels_.empty() ? BusState::kFault : BusState::kStarting;
  status_.fault = channels_.empty() ? BusFault::kNotConfigured : BusFault::kNone;
}

Result<> MaestroBus::Reboot(std::size_t servo) noexcept {
  if (servo >= channels_.size()) return Errc::kOutOfRange;
  return Errc::kUnsupported;
}

void MaestroBus::SetAll(ServoState state) noexcept {
  for (ServoFeedback& f : feedback_) {
    f.state = state;
    if (state != ServoState::kAbsent) continue;
    f.torque = false;
    f.position.reset();
  }
}

void MaestroBus::Obey(std::span<const ServoCommand> commands, Time now) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& c = channels_[i];
    const ServoCommand command = i < commands.size() ? commands[i] : ServoCommand{};
    if (!command.torque) {
      c.goal.reset();
    } else if (std::isfinite(command.position)) {
      const float within = std::clamp(command.position * maestro::kStepsPerMicrosecond,
                                      static_cast<float>(c.low), static_cast<float>(c.high));
      c.goal = static_cast<std::uint16_t>(std::lround(within));
    }
    if (c.let_go_at && Due(c.let_go_at, kLetGo, now)) c.let_go_at.reset();
    c.wants = command.torque && c.goal && !c.let_go_at && stage_ == Stage::kServe;
    if (feedback_[i].state == ServoState::kOn && !c.wants) feedback_[i].state = ServoState::kLimp;
  }
}

void MaestroBus::WriteTargets(Time now, bool release) noexcept {
  std::array<std::optional<std::uint16_t>, maestro::kMaxChannels> targets{};
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& c = channels_[i];
    ServoFeedback& f = feedback_[i];
    if (c.wants && f.state == ServoState::kLimp) {
      // One after the other: what they draw together at the start is what sags supplies.
      if (!Due(torque_at_, config_.bus.torque_interval, now)) continue;
      torque_at_ = now;
      f.state = ServoState::kOn;
      c.seen = c.missed = false;
    }
    const std::uint16_t target = c.wants ? *c.goal : std::uint16_t{0};
    if (!release && target == 0 && !c.pulsing && config_.answers) continue;
    if (!release && target == c.sent && !Due(c.sent_at, config_.bus.refresh, now)) continue;
    if (target != c.sent) c.changed_at = now;
    c.sent = target;
    c.sent_at = now;
    c.pulsing = c.pulsing || target != 0;
    if (!config_.answers) f.torque = target != 0;
    targets[config_.bus.servos[i].id] = target;
  }
  for (std::size_t first = 0; first < targets.size();) {
    if (!targets[first]) {
      ++first;
      continue;
    }
    std::array<std::uint16_t, maestro::kMaxChannels> run{};
    std::size_t count = 0;
    while (first + count < targets.size() && targets[first + count]) {
      run[count] = *targets[first + count];
      ++count;
      if (!config_.multi_target) break;
    }
    const auto channel = static_cast<std::uint8_t>(first);
    if (count == 1) {
      (void)out_.Took(encoder_.SetTarget(channel, run[0], out_.rest()));
    } else {
      (void)out_.Took(encoder_.SetTargets(channel, std::span(run).first(count), out_.rest()));
    }
    first += count;
  }
}

void MaestroBus::Ask(maestro::Reply reply, Time now) noexcept {
  const std::size_t before = out_.size();
  if (reply == maestro::Reply::kErrors) {
    (void)out_.Took(encoder_.GetErrors(out_.rest()));
  } else {
    (void)out_.Took(encoder_.GetPosition(config_.bus.servos[asked_].id, out_.rest()));
  }
  reader_.Expect(reply);
  ++status_.questions;
  const auto time_of = [&](std::size_t bytes) {
    return Duration(static_cast<std::int64_t>(bytes * 10 * 1'000'000 / config_.bus.baud + 1));
  };
  const Duration asking = time_of(out_.size() - before + 2);
  deadline_ = now + time_of(out_.size()) + asking + config_.bus.reply_timeout;
  const auto rest_us = static_cast<float>(asking.count()) / config_.bus.feedback_share;
  quiet_until_ = now + Duration(static_cast<std::int64_t>(rest_us));
}

void MaestroBus::Lost(Time now) noexcept {
  reader_.Forget();
  deadline_.reset();
  ++status_.lost;
  // A reply that comes after all must not be taken for that to the next question.
  quiet_until_ = now + config_.bus.reply_timeout;
  knocked_ = true;
  if (lost_in_row_ < config_.bus.gone_after) ++lost_in_row_;
  if (lost_in_row_ < config_.bus.gone_after && stage_ != Stage::kKnock) return;
  // Without replies nobody knows whether the board still does as it is told.
  SetAll(ServoState::kAbsent);
  stage_ = Stage::kResync;
  quiet_until_ = now + config_.bus.retry;
}

void MaestroBus::WriteQuestion(Time now) noexcept {
  if (deadline_ || (quiet_until_ && now < *quiet_until_)) return;
  switch (stage_) {
    case Stage::kResync:
      // A stray FF makes the board take the next two bytes for its own; what is then left of
      // this is harmless.
      for (int i = 0; i < 3; ++i) (void)out_.Took(encoder_.GetErrors(out_.rest()));
      reader_.Forget();
      quiet_until_ = now + config_.bus.reply_timeout;
      stage_ = Stage::kKnock;
      if (!config_.answers) {
        stage_ = Stage::kServe;
        SetAll(ServoState::kLimp);
      }
      return;
    case Stage::kKnock:
      return Ask(maestro::Reply::kErrors, now);
    case Stage::kRead:
      asked_ = turn_;
      return Ask(maestro::Reply::kPosition, now);
    case Stage::kServe:
      if (!config_.answers) return;
      if (again_) {
        again_ = false;
        return Ask(maestro::Reply::kPosition, now);
      }
      errors_next_ = !errors_next_;
      if (errors_next_) return Ask(maestro::Reply::kErrors, now);
      turn_ = (turn_ + 1) % channels_.size();
      asked_ = turn_;
      return Ask(maestro::Reply::kPosition, now);
  }
}

std::span<const std::byte> MaestroBus::Tick(Time now,
                                            std::span<const ServoCommand> commands) noexcept {
  out_.Clear();
  if (channels_.empty()) return {};
  if (deadline_ && now >= *deadline_) Lost(now);
  Obey(commands, now);
  // Replies have their own wire here: what needs none is never held back. A board that fell silent
  // may still hear, and is told to let go.
  if (stage_ == Stage::kServe || knocked_) WriteTargets(now, false);
  WriteQuestion(now);
  Summarise(now);
  return out_.bytes();
}

std::span<const std::byte> MaestroBus::Release(Time now) noexcept {
  out_.Clear();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    channels_[i].wants = false;
    channels_[i].pulsing = true;  // until it is read that it has none
    if (feedback_[i].state == ServoState::kOn) feedback_[i].state = ServoState::kLimp;
  }
  WriteTargets(now, true);
  Summarise(now);
  return out_.bytes();
}

void MaestroBus::Receive(std::span<const std::byte> bytes, Time now) noexcept {
  while (!bytes.empty()) {
    const maestro::Reply expected = reader_.expected();
    const auto value = reader_.Next(bytes);
    if (!value) {
      if (value.error() == Errc::kCorrupt) Lost(now);
      continue;
    }
    ++status_.replies;
    deadline_.reset();
    lost_in_row_ = 0;
    if (expected == maestro::Reply::kErrors) {
      TookErrors(*value);
    } else {
      TookPosition(asked_, *value, now);
    }
    Summarise(now);  // before the next commands are made: a servo with pulses shall keep them
  }
}

void MaestroBus::TookErrors(std::uint16_t errors) noexcept {
  if (stage_ == Stage::kKnock) {  // of the time before
    stage_ = Stage::kRead;
    turn_ = 0;
    SetAll(ServoState::kChecking);
    return;
  }
  status_.serial_errors = static_cast<std::uint16_t>(status_.serial_errors | errors);
}

void MaestroBus::TookPosition(std::size_t i, std::uint16_t value, Time now) noexcept {
  Channel& c = channels_[i];
  ServoFeedback& f = feedback_[i];
  f.torque = value != 0;
  f.position.reset();
  if (value != 0) {
    f.position = static_cast<float>(value) / maestro::kStepsPerMicrosecond;
    f.position_read = now;
  }
  if (stage_ == Stage::kRead) {
    c.sent = value;
    c.pulsing = c.pulsing || value != 0;
    if (++turn_ < channels_.size()) return;
    turn_ = 0;
    stage_ = Stage::kServe;
    SetAll(ServoState::kLimp);
    return;
  }
  if (c.sent == 0) c.pulsing = value != 0;
  if (f.state != ServoState::kOn) return;
  if (value == 0 && c.seen) {
    // It had its pulse, and has none: an error sent it home. Or a reply was damaged, which nothing
    // else shows; so it is asked for once more before that is believed.
    if (!c.missed) {
      c.missed = true;
      again_ = true;
      return;
    }
    ++status_.torque_lost;
    f.state = ServoState::kLimp;
    c.let_go_at = now;
    c.sent = 0;
    c.pulsing = false;
    return;
  }
  c.seen = c.seen || value != 0;
  c.missed = false;
  if (!Due(c.changed_at, kSettled, now)) return;
  NoteFinding(status_.findings,
              {.servo = static_cast<std::uint8_t>(i),
               .setting = Setting::kPulseRange,
               .found = value,
               .wanted = c.sent},
              value == c.sent);
}

void MaestroBus::Summarise(Time /*now*/) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    ServoFeedback& f = feedback_[i];
    const bool ready = f.state == ServoState::kLimp || f.state == ServoState::kOn;
    f.factor = ready && !channels_[i].let_go_at ? 1.0F : 0.0F;
    f.reason = f.factor == 1                      ? Reason::kNone
               : ready                            ? Reason::kHardware
               : f.state == ServoState::kChecking ? Reason::kStarting
               : knocked_                         ? Reason::kAbsent
                                                  : Reason::kStarting;
  }
  if (channels_.empty()) return;
  status_.fault = BusFault::kNone;
  if (stage_ == Stage::kServe) {
    status_.state = BusState::kRunning;
  } else if (stage_ == Stage::kRead) {
    status_.state = BusState::kChecking;
  } else if (!knocked_) {
    status_.state = BusState::kStarting;
  } else {
    status_.state = BusState::kFault;
    status_.fault = BusFault::kNobodyAnswers;
  }
}

}  // namespace facewire::bus
