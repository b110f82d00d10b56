#include "core/bus/receiver_bus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace facewire::bus {
namespace {

constexpr float kQuarters = 4;  // steps in a microsecond
constexpr float kMostSpeed = std::numeric_limits<std::uint16_t>::max();
// A receiver holds its servos after 100 ms without pulses, and crawls when they come again: one
// frame in a row may be lost.
constexpr Duration kKeepAlive = std::chrono::milliseconds(40);
constexpr Duration kStatusInterval = std::chrono::milliseconds(1000);
constexpr Duration kStatusLate = std::chrono::milliseconds(500);
// A status that was under way when a servo's pulses started says nothing about them.
constexpr Duration kSettled = std::chrono::milliseconds(500);
// A receiver that ended the pulses by itself had a reason; the motion then starts anew.
constexpr Duration kLetGo = std::chrono::milliseconds(500);

bool Due(const std::optional<Time>& last, Duration interval, Time now) noexcept {
  return !last || Between(*last, now) >= interval;
}

std::uint16_t LowestStep(float us) noexcept {
  return static_cast<std::uint16_t>(std::ceil(us * kQuarters));
}
std::uint16_t HighestStep(float us) noexcept {
  return static_cast<std::uint16_t>(std::floor(us * kQuarters));
}

// A limit is rounded down, but never to 0; 0 is none.
std::uint16_t LimitOf(float value) noexcept {
  return static_cast<std::uint16_t>(value == 0 ? kMostSpeed : std::clamp(value, 1.F, kMostSpeed));
}

bool IsSane(const ServoConfig& servo) noexcept {
  const bool range = servo.min * kQuarters >= wire::kMinPulseQuarterUs &&
                     servo.max * kQuarters <= wire::kMaxPulseQuarterUs &&
                     std::ceil(servo.min * kQuarters) <= std::floor(servo.max * kQuarters);
  const bool neutral =
      std::isnan(servo.neutral) || (servo.neutral >= servo.min && servo.neutral <= servo.max);
  const auto is_speed = [](float value) { return value >= 0 && std::isfinite(value); };
  return servo.id < kMaxServos && range && neutral && servo.arrive_speed_per_s > 0 &&
         is_speed(servo.arrive_speed_per_s) && is_speed(servo.arrive_acceleration_per_s2) &&
         is_speed(servo.top_speed_per_s);
}

std::uint32_t Milliseconds(Duration time) noexcept {
  return static_cast<std::uint32_t>(time / std::chrono::milliseconds(1));
}
bool IsTime(Duration time) noexcept {
  return time >= Duration::zero() &&
         time <= std::chrono::milliseconds(std::numeric_limits<std::uint32_t>::max());
}

// FNV-1a of everything in a setup: another one has another name, and the same one keeps its name
// when the device starts anew, so that a receiver just goes on.
std::uint32_t IdOf(const wire::ServoSetup& setup) noexcept {
  std::uint32_t hash = 2166136261U;
  const auto add = [&](std::uint32_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      hash = (hash ^ ((value >> shift) & 0xFFU)) * 16777619U;
    }
  };
  add(setup.hold_ms);
  add(setup.ease_ms);
  add(setup.release_ms);
  for (const wire::ServoLimits& servo : setup.servos) {
    add(servo.min_quarter_us);
    add(servo.neutral_quarter_us);
    add(servo.max_quarter_us);
    add(servo.speed_us_s);
    add(servo.ramp_speed_us_s);
    add(servo.ramp_acceleration_10us_s2);
  }
  return hash == 0 ? 1 : hash;
}

}  // namespace

Result<> ReceiverBus::Configure(const ReceiverConfig& config) noexcept {
  const auto& servos = config.bus.servos;
  if (servos.empty() || config.bus.baud < 1200 || config.bus.refresh <= Duration::zero() ||
      config.bus.retry <= Duration::zero() || config.bus.torque_interval < Duration::zero() ||
      config.bus.gone_after == 0 || !IsTime(config.hold) || !IsTime(config.ease) ||
      !IsTime(config.release)) {
    return Errc::kOutOfRange;
  }
  for (std::size_t i = 0; i < servos.size(); ++i) {
    if (!IsSane(servos[i])) return Errc::kOutOfRange;
    for (std::size_t j = 0; j < i; ++j) {
      if (servos[j].id == servos[i].id) return Errc::kOutOfRange;
    }
  }
  config_ = config;
  status_ = {};
  encoder_ = {};
  channels_.clear();
  feedback_.clear();
  (void)channels_.try_resize(servos.size());  // of the same capacity
  (void)feedback_.try_resize(servos.size());
  for (std::size_t i = 0; i < servos.size(); ++i) {
    channels_[i].low = LowestStep(servos[i].min);
    channels_[i].high = HighestStep(servos[i].max);
  }
  Restart();
  return {};
}

wire::ServoLimits ReceiverBus::LimitsOf(std::size_t i) const noexcept {
  const ServoConfig& servo = config_.bus.servos[i];
  const float neutral = std::isnan(servo.neutral) ? (servo.min + servo.max) / 2 : servo.neutral;
  const auto nearest = static_cast<std::uint16_t>(std::lround(neutral * kQuarters));
  const float acceleration = servo.arrive_acceleration_per_s2;
  return {.min_quarter_us = channels_[i].low,
          .neutral_quarter_us = std::clamp(nearest, channels_[i].low, channels_[i].high),
          .max_quarter_us = channels_[i].high,
          .speed_us_s = LimitOf(servo.top_speed_per_s),
          .ramp_speed_us_s = LimitOf(servo.arrive_speed_per_s),
          .ramp_acceleration_10us_s2 =
              LimitOf(acceleration == 0 ? 0 : std::max(acceleration / 10, 1.F))};
}

// As far as the receiver has outputs. Those that no servo of ours is at never get a pulse, so their
// limits do not matter.
void ReceiverBus::MakeSetup() noexcept {
  setup_ = {.hold_ms = Milliseconds(config_.hold),
            .ease_ms = Milliseconds(config_.ease),
            .release_ms = Milliseconds(config_.release)};
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const std::size_t id = config_.bus.servos[i].id;
    if (id >= capacity_) continue;
    if (id >= setup_.servos.size()) (void)setup_.servos.try_resize(id + 1);  // IsSane
    setup_.servos[id] = LimitsOf(i);
  }
  setup_.setup_id = IdOf(setup_);
}

void ReceiverBus::Restart() noexcept {
  for (Channel& c : channels_) c = {.low = c.low, .high = c.high};
  decoder_ = {};
  receiver_.reset();
  capacity_ = kMaxServos;
  MakeSetup();
  SetAll(ServoState::kAbsent);
  stage_ = Stage::kSeek;
  fell_silent_ = released_ = echoes_ = false;
  unanswered_ = missed_ = 0;
  setup_at_.reset();
  sent_at_.reset();
  torque_at_.reset();
  status_due_.reset();
  line_free_.reset();
  status_.findings.clear();
  Summarise();
}

Result<> ReceiverBus::Reboot(std::size_t servo) noexcept {
  if (servo >= channels_.size()) return Errc::kOutOfRange;
  return Errc::kUnsupported;
}

void ReceiverBus::SetAll(ServoState state) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    ServoFeedback& f = feedback_[i];
    const bool refused = state == ServoState::kLimp && config_.bus.servos[i].id >= capacity_;
    f.state = refused ? ServoState::kRefused : state;
    if (state != ServoState::kAbsent) continue;
    f.torque = false;
    f.position.reset();
    f.voltage_v.reset();
  }
}

void ReceiverBus::Obey(std::span<const ServoCommand> commands, Time now) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& c = channels_[i];
    ServoFeedback& f = feedback_[i];
    const ServoCommand command = i < commands.size() ? commands[i] : ServoCommand{};
    if (!command.torque) {
      c.goal.reset();
    } else if (std::isfinite(command.position)) {
      const float within = std::clamp(command.position * kQuarters, static_cast<float>(c.low),
                                      static_cast<float>(c.high));
      c.goal = static_cast<std::uint16_t>(std::lround(within));
    }
    if (c.let_go_at && Due(c.let_go_at, kLetGo, now)) c.let_go_at.reset();
    const bool usable = f.state == ServoState::kLimp || f.state == ServoState::kOn;
    c.wants = command.torque && c.goal && !c.let_go_at && usable;
    if (f.state == ServoState::kOn && !c.wants) f.state = ServoState::kLimp;
    if (c.wants) released_ = false;
  }
}

void ReceiverBus::WatchSilence(Time now) noexcept {
  if (!status_due_ || now < *status_due_) return;
  ++status_.lost;
  status_due_ = *status_due_ + kStatusInterval;
  if (++missed_ < config_.bus.gone_after) return;
  // Nobody knows whether it still does as it is told.
  status_due_.reset();
  stage_ = Stage::kSeek;
  fell_silent_ = true;
  unanswered_ = config_.bus.gone_after + 1U;
  SetAll(ServoState::kAbsent);
}

template <class Message>
void ReceiverBus::Say(const Message& message, Time now) noexcept {
  const std::size_t before = out_.size();
  (void)out_.Took(encoder_.Encode(message, out_.rest()));
  const auto bits = static_cast<std::int64_t>(10 * (out_.size() - before));
  line_free_ =
      std::max(now, line_free_.value_or(now)) + Duration(bits * 1'000'000 / config_.bus.baud);
}

void ReceiverBus::WriteSetup(Time now) noexcept {
  if (stage_ == Stage::kServe || !Due(setup_at_, config_.bus.retry, now)) return;
  setup_at_ = now;
  ++status_.questions;
  if (unanswered_ <= config_.bus.gone_after) ++unanswered_;
  Say(setup_, now);
}

void ReceiverBus::WritePulses(Time now, bool at_once) noexcept {
  wire::ServoPulses pulses{.setup_id = setup_.setup_id, .stop = released_};
  (void)pulses.quarter_us.try_resize(setup_.servos.size());  // of the same capacity
  bool changed = at_once;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& c = channels_[i];
    ServoFeedback& f = feedback_[i];
    if (config_.bus.servos[i].id >= pulses.quarter_us.size()) continue;
    // One after the other: what they draw together at the start is what sags supplies. One that was
    // found with its pulse has started already.
    const bool may_start = f.torque || Due(torque_at_, config_.bus.torque_interval, now);
    if (c.wants && f.state == ServoState::kLimp && may_start) {
      if (!f.torque) torque_at_ = now;
      f.state = ServoState::kOn;
      c.on_at = now;
    }
    const bool on = c.wants && f.state == ServoState::kOn;
    const std::uint16_t width = on ? *c.goal : std::uint16_t{0};
    changed = changed || width != c.sent;
    c.sent = width;
    pulses.quarter_us[config_.bus.servos[i].id] = width;
  }
  if (!changed && !Due(sent_at_, std::min(config_.bus.refresh, kKeepAlive), now)) return;
  sent_at_ = now;
  Say(pulses, now);
}

std::span<const std::byte> ReceiverBus::Tick(Time now,
                                             std::span<const ServoCommand> commands) noexcept {
  out_.Clear();
  if (channels_.empty()) return {};
  WatchSilence(now);
  Obey(commands, now);
  if (line_free_ && now < *line_free_) {
    ++status_.held_back;  // it would only queue up, and be old when it is heard
  } else {
    WriteSetup(now);
    // Before a receiver is heard it may be at work from before, and where it is has to be read
    // first; one that fell silent may still hear, and is told to let go.
    const bool may_hear = stage_ == Stage::kSeek && (fell_silent_ || released_);
    if (stage_ == Stage::kServe || may_hear) WritePulses(now, false);
  }
  Summarise();
  return out_.bytes();
}

// The stop flag is there because the receiver answers it at once, with a status.
std::span<const std::byte> ReceiverBus::Release(Time now) noexcept {
  out_.Clear();
  if (channels_.empty()) return {};
  released_ = true;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    channels_[i].wants = false;
    if (feedback_[i].state == ServoState::kOn) feedback_[i].state = ServoState::kLimp;
  }
  WritePulses(now, true);
  Summarise();
  return out_.bytes();
}

void ReceiverBus::Receive(std::span<const std::byte> bytes, Time now) noexcept {
  if (channels_.empty()) return;
  for (;;) {
    const auto received = decoder_.Next(bytes);
    if (!received) {
      if (received.error() == Errc::kNotReady) return;
      continue;
    }
    if (const auto* said = std::get_if<wire::ReceiverStatus>(&received->message)) {
      TookStatus(*said, now);
      Summarise();  // before the next commands are made: a servo with a pulse shall keep it
    } else if (std::holds_alternative<wire::ServoSetup>(received->message)) {
      echoes_ = true;
    }
  }
}

void ReceiverBus::TookCapacity(std::uint8_t capacity) noexcept {
  if (capacity == capacity_) return;
  capacity_ = capacity;
  MakeSetup();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const std::int32_t needed = config_.bus.servos[i].id + 1;
    NoteFinding(status_.findings,
                {.servo = static_cast<std::uint8_t>(i),
                 .setting = Setting::kOutputs,
                 .found = capacity,
                 .wanted = needed,
                 .refused = true},
                needed <= capacity);
  }
}

void ReceiverBus::TookStatus(const wire::ReceiverStatus& said, Time now) noexcept {
  receiver_ = said;
  ++status_.replies;
  missed_ = 0;
  echoes_ = false;
  status_due_ = now + kStatusInterval + kStatusLate;
  TookCapacity(said.capacity);
  const bool ours = said.setup_id == setup_.setup_id;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const std::size_t id = config_.bus.servos[i].id;
    const std::uint16_t width =
        id < said.quarter_us.size() ? said.quarter_us[id] : std::uint16_t{0};
    if (ours) TookPulse(i, width, now);
    ServoFeedback& f = feedback_[i];
    f.torque = width != 0;
    f.position.reset();
    if (f.torque) {
      f.position = static_cast<float>(width) / kQuarters;
      f.position_read = now;
    }
    f.voltage_v.reset();
    if (said.supply_mv != 0) f.voltage_v = static_cast<float>(said.supply_mv) * 1e-3F;
  }
  if (ours) {
    unanswered_ = 0;
    if (stage_ != Stage::kServe) SetAll(ServoState::kLimp);
    stage_ = Stage::kServe;
    return;
  }
  for (const ServoFeedback& f : feedback_) {
    if (f.state == ServoState::kOn) ++status_.torque_lost;
  }
  SetAll(ServoState::kChecking);
  stage_ = Stage::kSetup;
}

void ReceiverBus::TookPulse(std::size_t i, std::uint16_t width, Time now) noexcept {
  Channel& c = channels_[i];
  ServoFeedback& f = feedback_[i];
  if (width != 0 || f.state != ServoState::kOn || !Due(c.on_at, kSettled, now)) return;
  // It had its pulse, and has none: the receiver's own failsafe ran out.
  ++status_.torque_lost;
  f.state = ServoState::kLimp;
  c.let_go_at = now;
}

void ReceiverBus::Summarise() noexcept {
  const bool given_up = unanswered_ > config_.bus.gone_after;
  bool all_refused = true;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    ServoFeedback& f = feedback_[i];
    const bool ready = f.state == ServoState::kLimp || f.state == ServoState::kOn;
    all_refused = all_refused && f.state == ServoState::kRefused;
    f.factor = ready && !channels_[i].let_go_at ? 1.0F : 0.0F;
    f.reason = f.factor == 1                                ? Reason::kNone
               : ready                                      ? Reason::kHardware
               : f.state == ServoState::kRefused            ? Reason::kSettings
               : f.state == ServoState::kAbsent && given_up ? Reason::kAbsent
                                                            : Reason::kStarting;
  }
  status_.fault = BusFault::kNone;
  if (channels_.empty()) {
    status_.state = BusState::kFault;
    status_.fault = BusFault::kNotConfigured;
  } else if (stage_ == Stage::kServe) {
    status_.state = all_refused ? BusState::kFault : BusState::kRunning;
    if (all_refused) status_.fault = BusFault::kSettings;
  } else if (given_up) {
    status_.state = BusState::kFault;
    status_.fault = echoes_ ? BusFault::kEcho : BusFault::kNobodyAnswers;
  } else {
    status_.state = stage_ == Stage::kSetup ? BusState::kChecking : BusState::kStarting;
  }
}

}  // namespace facewire::bus
