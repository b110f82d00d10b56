// The asking half of ChainBus: which question is next, and what its answers mean.
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "core/bus/chain_bus.h"

namespace facewire::bus {
namespace {

// Two readings of a servo at rest differ by less, and damage that a checksum missed by more.
constexpr std::int32_t kAgree = 64;  // counts, 5.6 degrees
constexpr std::int32_t kThere = 8;   // counts, 0.7 degrees
constexpr std::int32_t kStill = 2;   // what a sensor trembles
constexpr Duration kRest = std::chrono::milliseconds(300);
constexpr int kLooksInRow = 3;

bool Due(const std::optional<Time>& last, Duration interval, Time now) noexcept {
  return !last || Between(*last, now) >= interval;
}

constexpr bool IsThere(ServoState state) noexcept {
  return state != ServoState::kAbsent && state != ServoState::kRefused;
}

}  // namespace

void ChainBus::PickOne(Block block, std::size_t part, std::size_t i) noexcept {
  block_ = block;
  part_ = part;
  asked_.clear();
  (void)asked_.try_push(static_cast<std::uint8_t>(i));
}

// The next part of kHealth of those that wait for it, several at once.
bool ChainBus::PickLook(Time now, bool only_urgent) noexcept {
  asked_.clear();
  for (std::size_t n = 0; n < members_.size() && asked_.size() < MostAsked(); ++n) {
    const std::size_t i = (look_turn_ + n) % members_.size();
    const Member& m = members_[i];
    if (state(i) == ServoState::kAbsent || (IsThere(state(i)) && !m.settings_read)) continue;
    const bool due = m.look_part != 0 || Due(m.looked_at, config_.look_after, now);
    if (!m.look_now && (only_urgent || !due)) continue;
    // In a row of answers each servo waits for the one before it: one that may be gone is asked
    // alone, or it would silence the others.
    if (m.lost_in_row != 0) {
      if (!asked_.empty()) continue;
      PickOne(Block::kHealth, m.look_part, i);
      break;
    }
    if (asked_.empty()) {
      block_ = Block::kHealth;
      part_ = m.look_part;
    }
    if (m.look_part == part_) (void)asked_.try_push(static_cast<std::uint8_t>(i));
  }
  if (asked_.empty()) return false;
  // Who has parts left is first in turn again.
  if (part_ + 1 == Parts(Block::kHealth)) look_turn_ = asked_[asked_.size() - 1] + 1U;
  return true;
}

bool ChainBus::PickStatus() noexcept {
  asked_.clear();
  for (std::size_t n = 0; n < members_.size() && asked_.size() < MostAsked(); ++n) {
    const std::size_t i = (turn_ + n) % members_.size();
    if (!IsThere(state(i)) || !members_[i].settings_read) continue;
    const bool alone = members_[i].lost_in_row != 0;
    if (alone && !asked_.empty()) break;
    block_ = Block::kStatus;
    part_ = 0;
    (void)asked_.try_push(static_cast<std::uint8_t>(i));
    if (alone) break;
  }
  if (asked_.empty()) return false;
  turn_ = asked_[asked_.size() - 1] + 1U;
  return true;
}

bool ChainBus::PickAbsent(Time now) noexcept {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (state(i) == ServoState::kAbsent && !members_[i].tried_at) {
      PickOne(Block::kSettings, 0, i);
      return true;
    }
  }
  if (!Due(hunted_, config_.retry, now)) return false;
  std::optional<std::size_t> longest;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    // One that was refused is read again too: somebody may have put it right.
    if (state(i) != ServoState::kAbsent && state(i) != ServoState::kRefused) continue;
    if (!Due(members_[i].tried_at, config_.retry, now)) continue;
    if (!longest || *members_[i].tried_at < *members_[*longest].tried_at) longest = i;
  }
  if (!longest) return false;
  hunted_ = now;
  PickOne(Block::kSettings, 0, *longest);
  return true;
}

bool ChainBus::PickQuestion(Time now) noexcept {
  if (PickAbsent(now)) return true;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Member& m = members_[i];
    if (m.settings_part == 0 && (state(i) != ServoState::kChecking || m.settings_read)) continue;
    PickOne(Block::kSettings, m.settings_part, i);
    return true;
  }
  // Who waits for torque is looked at first, but not for ever: positions get old.
  ++looks_in_row_;
  if (looks_in_row_ <= kLooksInRow && PickLook(now, true)) return true;
  if (looks_in_row_ <= 1 && PickLook(now, false)) return true;
  looks_in_row_ = 0;
  return PickStatus() || PickLook(now, false);
}

bool ChainBus::WriteQuestion(Time now, PacketBuffer& out) noexcept {
  if (ask_again_ && now < *ask_again_) return false;
  if (members_.empty() || !PickQuestion(now)) return false;
  InlineVector<std::uint8_t, kMaxServos> ids;
  for (std::uint8_t i : asked_) {
    members_[i].tried_at = now;
    (void)ids.try_push(config_.servos[i].id);
  }
  const std::size_t before = out.size();
  const std::size_t question = MakeQuestion(block_, part_, ids.span(), out.rest());
  out.Took(question);
  asking_ = true;
  ++status_.questions;
  const auto time_of = [&](std::size_t bytes) {
    return Duration(static_cast<std::int64_t>(bytes * 10 * 1'000'000 / config_.baud + 1));
  };
  const Duration asking = time_of(question + ids.size() * AnswerBytes(block_, part_));
  deadline_ = now + time_of(before) + asking + config_.reply_timeout;
  const auto rest_us = static_cast<float>(asking.count()) / config_.feedback_share;
  ask_again_ = now + Duration(static_cast<std::int64_t>(rest_us));
  return true;
}

void ChainBus::GiveUpReplies() noexcept {
  ForgetAnswers();
  asking_ = false;
  deadline_.reset();
  for (std::uint8_t i : asked_) {
    Member& m = members_[i];
    ++status_.lost;
    ++feedback_[i].lost;
    if (m.lost_in_row < config_.gone_after) ++m.lost_in_row;
    if (m.lost_in_row < config_.gone_after || state(i) == ServoState::kAbsent) continue;
    // Nobody can see its heat any more, and it may hear though it is not heard: it is let go.
    if (state(i) == ServoState::kArming || state(i) == ServoState::kOn) Drop(i);
    Forget(i);
  }
  asked_.clear();
}

void ChainBus::Receive(std::span<const std::byte> bytes, Time now) noexcept {
  while (const auto answer = NextAnswer(bytes)) {
    const auto asked = std::find_if(asked_.begin(), asked_.end(), [&](std::uint8_t i) {
      return config_.servos[i].id == answer->id;
    });
    if (asked == asked_.end()) continue;  // late, or not to this question
    const std::size_t i = *asked;
    if (answer->alert && members_[i].faults == 0) members_[i].look_now = true;
    if (!answer->good) continue;  // as good as lost: there is nothing in it
    ++status_.replies;
    *asked = *(asked_.end() - 1);
    (void)asked_.try_resize(asked_.size() - 1);
    members_[i].lost_in_row = 0;
    Took(i, answer->data, now);
    Summarise(now);  // before the next commands are made: a servo with torque shall keep it
  }
  if (asking_ && asked_.empty()) {
    asking_ = false;
    deadline_.reset();
  }
}

void ChainBus::Took(std::size_t i, std::span<const std::byte> data, Time now) noexcept {
  Member& m = members_[i];
  switch (block_) {
    case Block::kSettings:
      return TookSettings(i, data);
    case Block::kHealth:
      TakeHealth(i, part_, data, m.health);
      m.look_part = static_cast<std::uint8_t>((part_ + 1) % Parts(Block::kHealth));
      if (m.look_part == 0) TookHealth(i, m.health, now);
      return;
    case Block::kStatus:
      return TookReading(i, TakeStatus(i, data), now);
  }
}

void ChainBus::TookSettings(std::size_t i, std::span<const std::byte> data) noexcept {
  Member& m = members_[i];
  if (part_ == 0) m.unusable = false;
  m.unusable = !TakeSettings(i, part_, data) || m.unusable;
  m.settings_part = static_cast<std::uint8_t>((part_ + 1) % Parts(Block::kSettings));
  if (state(i) == ServoState::kAbsent) state(i) = ServoState::kChecking;
  if (m.settings_part != 0) return;
  state(i) = m.unusable ? ServoState::kRefused : ServoState::kChecking;
  m.settings_read = !m.unusable;
  LookSoon(m);
}

void ChainBus::TookHealth(std::size_t i, const Health& health, Time now) noexcept {
  Member& m = members_[i];
  m.looked = true;
  m.looked_at = now;
  m.look_now = false;
  feedback_[i].torque = health.torque;
  if (health.faults) {
    m.faults = *health.faults;
    feedback_[i].faults = m.faults;
    m.guard.Update(now, {}, {}, m.faults);
  }
  switch (state(i)) {
    case ServoState::kArming:
      if (!m.torque_sent) {
        m.confirmed = health.goal == m.sent && health.slow && health.watched;
        if (!m.confirmed) m.prepared = false;  // again
      } else if (health.torque) {
        state(i) = ServoState::kOn;
      } else {
        m.prepared = m.confirmed = m.torque_sent = false;
      }
      return;
    case ServoState::kOn:
      if (!health.torque || !health.watched) {
        ++status_.torque_lost;
        Drop(i);
      } else if (!(m.arriving ? health.slow : health.normal)) {
        m.hurry = true;  // it did not hear
      }
      return;
    case ServoState::kRefused:
    case ServoState::kLimp:
      m.off_known = m.off_known || !health.torque;
      if (health.torque && state(i) == ServoState::kRefused) m.off_known = false;
      return;
    case ServoState::kAbsent:
    case ServoState::kChecking:
      return;
  }
}

void ChainBus::TookReading(std::size_t i, const Reading& reading, Time now) noexcept {
  Member& m = members_[i];
  ServoFeedback& f = feedback_[i];
  f.temperature_c = reading.temperature_c;
  f.load = reading.load;
  f.voltage_v = reading.voltage_v;
  if (reading.faults) m.faults = *reading.faults;
  f.faults = m.faults;
  m.guard.Update(now, reading.temperature_c, reading.load, m.faults);

  const bool agrees = m.reading && std::abs(reading.position - *m.reading) <= kAgree;
  if (std::abs(reading.position - m.rests_at) > kStill) {
    m.rests_at = reading.position;
    m.rests_since = now;
  }
  m.reading = reading.position;
  if (agrees || state(i) == ServoState::kOn) {
    f.position = static_cast<float>(reading.position);
    f.position_read = now;
  }
  if (state(i) == ServoState::kChecking && agrees && m.looked) state(i) = ServoState::kLimp;
  if (state(i) == ServoState::kOn && m.arriving) {
    // A load keeps a servo from its goal: close by and at rest is as near as it gets.
    const std::int32_t off = std::abs(reading.position - m.sent);
    const std::int32_t close = std::max(kThere, (m.high - m.low) / 50);
    const bool rests = Between(m.rests_since, now) >= kRest;
    if (off <= kThere || (off <= close && rests)) {
      m.arriving = false;
      m.hurry = true;
    }
  }
}

void ChainBus::Summarise(Time now) noexcept {
  bool running = false, checking = false, refused = false, untried = false;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& m = members_[i];
    ServoFeedback& f = feedback_[i];
    m.guard.Update(now, {}, {}, m.faults);
    f.factor = m.guard.factor();
    f.reason = m.guard.reason();
    switch (f.state) {
      case ServoState::kAbsent:
        f.factor = 0;
        f.reason = m.tried_at ? Reason::kAbsent : Reason::kStarting;
        untried = untried || !m.tried_at;
        break;
      case ServoState::kChecking:
        f.factor = 0;
        f.reason = Reason::kStarting;
        checking = true;
        break;
      case ServoState::kRefused:
        f.factor = 0;
        f.reason = Reason::kSettings;
        refused = true;
        break;
      case ServoState::kLimp:
      case ServoState::kArming:
      case ServoState::kOn:
        running = true;
        break;
    }
  }
  if (members_.empty()) return;
  status_.fault = BusFault::kNone;
  if (running) {
    status_.state = BusState::kRunning;
  } else if (checking) {
    status_.state = BusState::kChecking;
  } else if (untried || (deadline_ && status_.state == BusState::kStarting)) {
    status_.state = BusState::kStarting;
  } else {
    status_.state = BusState::kFault;
    status_.fault = refused    ? BusFault::kSettings
                    : Echoes() ? BusFault::kEcho
                               : BusFault::kNobodyAnswers;
  }
}

}  // namespace facewire::bus
