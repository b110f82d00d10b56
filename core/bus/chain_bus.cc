#include "core/bus/chain_bus.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace facewire::bus {
namespace {

constexpr float kMostCounts = 1e6F;  // far more than any turn, and exact in a float
constexpr Duration kRebootTime = std::chrono::milliseconds(1000);  // Feetech: 800 ms

bool Due(const std::optional<Time>& last, Duration interval, Time now) noexcept {
  return !last || Between(*last, now) >= interval;
}

bool IsSane(const ServoConfig& servo, std::uint8_t max_id) noexcept {
  return servo.id <= max_id && std::isfinite(servo.min) && std::isfinite(servo.max) &&
         std::abs(servo.min) <= kMostCounts && std::abs(servo.max) <= kMostCounts &&
         std::ceil(servo.min) <= std::floor(servo.max) && servo.arrive_speed_per_s >= 1 &&
         servo.arrive_speed_per_s <= kMostCounts && servo.arrive_acceleration_per_s2 >= 0 &&
         servo.arrive_acceleration_per_s2 <= kMostCounts && servo.top_speed_per_s >= 0 &&
         servo.top_speed_per_s <= kMostCounts;
}

}  // namespace

Result<> ChainBus::ConfigureChain(const BusConfig& config, std::uint8_t max_id) noexcept {
  const auto& servos = config.servos;
  if (servos.empty() || config.baud < 1200 || !(config.feedback_share >= 0.01F) ||
      !(config.feedback_share <= 0.9F) || config.reply_timeout <= Duration::zero() ||
      config.refresh <= Duration::zero() || config.look_after <= Duration::zero() ||
      config.retry <= Duration::zero() || config.torque_interval < Duration::zero() ||
      config.gone_after == 0) {
    return Errc::kOutOfRange;
  }
  for (std::size_t i = 0; i < servos.size(); ++i) {
    if (!IsSane(servos[i], max_id)) return Errc::kOutOfRange;
    for (std::size_t j = 0; j < i; ++j) {
      if (servos[i].id == servos[j].id) return Errc::kOutOfRange;
    }
  }
  config_ = config;
  members_.clear();
  feedback_.clear();
  status_ = {};
  (void)members_.try_resize(servos.size());  // of the same capacity
  (void)feedback_.try_resize(servos.size());
  for (std::size_t i = 0; i < servos.size(); ++i) {
    members_[i].low = static_cast<std::int32_t>(std::ceil(servos[i].min));
    members_[i].high = static_cast<std::int32_t>(std::floor(servos[i].max));
    members_[i].guard = Guard(servos[i].guard);
  }
  Restart();
  return {};
}

void ChainBus::Restart() noexcept {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Forget(i);
    members_[i].tried_at.reset();
  }
  asked_.clear();
  asking_ = false;
  deadline_.reset();
  ask_again_.reset();
  hunted_.reset();
  torque_at_.reset();
  ForgetAnswers();
  status_.findings.clear();
  status_.state = members_.empty() ? BusState::kFault : BusState::kStarting;
  status_.fault = members_.empty() ? BusFault::kNotConfigured : BusFault::kNone;
}

void ChainBus::Forget(std::size_t i) noexcept {
  const Member& old = members_[i];
  Member fresh;
  fresh.low = old.low;
  fresh.high = old.high;
  fresh.guard = old.guard;
  fresh.faults = old.faults;
  fresh.tried_at = old.tried_at;
  fresh.off_known = old.off_known;  // one that had torque is told to let go though it is not heard
  fresh.off_at = old.off_at;
  members_[i] = fresh;
  state(i) = ServoState::kAbsent;
  feedback_[i].torque = false;
  feedback_[i].position.reset();
}

void ChainBus::Drop(std::size_t i) noexcept {
  Member& m = members_[i];
  m.off_known = false;
  m.off_at.reset();
  m.prepared = m.confirmed = m.torque_sent = false;
  m.arriving = m.hurry = false;
  m.sent_at.reset();
  if (state(i) == ServoState::kArming || state(i) == ServoState::kOn) state(i) = ServoState::kLimp;
}

Result<> ChainBus::Reboot(std::size_t servo) noexcept {
  if (servo >= members_.size()) return Errc::kOutOfRange;
  members_[servo].reboot = true;
  return {};
}

ChainBus::Goal ChainBus::GoalOf(std::size_t i) const noexcept {
  const Member& m = members_[i];
  const bool slow = m.arriving || feedback_[i].state == ServoState::kArming;
  return {.servo = i, .id = config_.servos[i].id, .counts = m.goal.value_or(m.sent), .slow = slow};
}

void ChainBus::Obey(std::span<const ServoCommand> commands) noexcept {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& m = members_[i];
    const ServoCommand command = i < commands.size() ? commands[i] : ServoCommand{};
    if (!command.torque) {
      m.goal.reset();
    } else if (std::isfinite(command.position)) {
      const float within =
          std::clamp(command.position, static_cast<float>(m.low), static_cast<float>(m.high));
      m.goal = static_cast<std::int32_t>(std::lround(within));
    }
    const ServoState s = state(i);
    const bool ready = s == ServoState::kLimp || s == ServoState::kArming || s == ServoState::kOn;
    m.wants = command.torque && ready && m.goal && m.guard.factor() > 0 && !m.reboot;
    if (!m.wants && (s == ServoState::kArming || s == ServoState::kOn)) Drop(i);
    // One that kept its torque from before the program started may keep it until it is told.
    const bool let_go = !command.torque || m.guard.factor() <= 0;
    if (let_go && ready && feedback_[i].torque && m.off_known) Drop(i);
  }
}

std::span<const std::byte> ChainBus::Tick(Time now,
                                          std::span<const ServoCommand> commands) noexcept {
  Obey(commands);
  if (deadline_) {
    if (now < *deadline_) {
      ++status_.held_back;
      Summarise(now);
      return {};
    }
    GiveUpReplies();
  }
  PacketBuffer& out = out_;
  out.Clear();
  WriteOff(now, out);
  WriteArming(now, out);
  WriteGoals(now, out);
  // What is answered comes last: it is this packet that the line then belongs to.
  if (!WriteReboot(now, out)) WriteQuestion(now, out);
  Summarise(now);
  return out.bytes();
}

std::span<const std::byte> ChainBus::Release(Time now) noexcept {
  if (members_.empty()) return {};
  PacketBuffer& out = out_;
  out.Clear();
  out.Took(MakeRelease(out.rest()));
  for (std::size_t i = 0; i < members_.size(); ++i) {
    members_[i].wants = false;
    Drop(i);
  }
  asked_.clear();
  asking_ = false;
  ForgetAnswers();
  deadline_ = now + config_.reply_timeout;  // replies that this talked into come to an end
  Summarise(now);
  return out.bytes();
}

void ChainBus::WriteOff(Time now, PacketBuffer& out) noexcept {
  InlineVector<std::uint8_t, kMaxServos> ids;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& m = members_[i];
    if (m.off_known) continue;
    const Duration interval = state(i) == ServoState::kAbsent ? config_.retry : config_.refresh;
    if (!Due(m.off_at, interval, now)) continue;
    m.off_at = now;
    LookSoon(m);
    (void)ids.try_push(config_.servos[i].id);
  }
  if (!ids.empty()) out.Took(MakeTorque(ids.span(), false, out.rest()));
}

void ChainBus::WriteArming(Time now, PacketBuffer& out) noexcept {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& m = members_[i];
    if (!m.wants || (state(i) != ServoState::kLimp && state(i) != ServoState::kArming)) continue;
    if (state(i) == ServoState::kLimp) {
      // One after the other: what they draw together at the start is what sags supplies.
      if (torque_at_ == now || !Due(torque_at_, config_.torque_interval, now)) continue;
      // One that was told to let go has to say first that it did: after its watchdog or an error
      // nobody knows which goal it would go on to.
      if (!m.off_known) continue;
      torque_at_ = now;
      state(i) = ServoState::kArming;
      m.arriving = true;
      m.prepared = m.confirmed = m.torque_sent = false;
    }
    // On a bad line the confirmation may take long, and the motion goes on meanwhile.
    if (!m.torque_sent && m.prepared && Due(m.sent_at, config_.look_after, now)) {
      m.prepared = m.confirmed = false;
    }
    if (!m.prepared) {
      const Goal goal = GoalOf(i);
      m.sent = goal.counts;
      m.sent_at = now;
      m.prepared = true;
      LookSoon(m);
      out.Took(MakeArming(goal, out.rest()));
    } else if (m.confirmed && !m.torque_sent) {
      m.torque_sent = true;
      LookSoon(m);
      const std::array ids = {config_.servos[i].id};
      out.Took(MakeTorque(ids, true, out.rest()));
    }
  }
}

void ChainBus::WriteGoals(Time now, PacketBuffer& out) noexcept {
  InlineVector<Goal, kMaxServos> goals;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& m = members_[i];
    if (state(i) != ServoState::kOn) continue;
    const Goal goal = GoalOf(i);
    if (m.hurry) {
      m.hurry = false;
      m.sent_at.reset();
      out.Took(MakePace(goal, out.rest()));
    }
    if (goal.counts == m.sent && !Due(m.sent_at, config_.refresh, now)) continue;
    m.sent = goal.counts;
    m.sent_at = now;
    (void)goals.try_push(goal);
  }
  if (!goals.empty()) out.Took(MakeGoals(goals.span(), out.rest()));
}

bool ChainBus::WriteReboot(Time now, PacketBuffer& out) noexcept {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (!members_[i].reboot) continue;
    const std::array ids = {config_.servos[i].id};
    out.Took(MakeTorque(ids, false, out.rest()));
    out.Took(MakeReboot(ids[0], out.rest()));
    Forget(i);
    members_[i].off_known = true;  // it starts without
    members_[i].tried_at = now + kRebootTime;
    asked_.clear();
    ForgetAnswers();
    deadline_ = now + config_.reply_timeout;  // it may acknowledge, which nobody needs
    return true;
  }
  return false;
}

}  // namespace facewire::bus
