#include "core/wire/osc_host/pose_writer.h"

#include <algorithm>

#include "core/wire/osc/osc.h"
#include "core/wire/osc/slip.h"
#include "core/wire/osc_host/address.h"
#include "core/wire/osc_host/command.h"
#include "core/wire/pose.h"

namespace facewire::wire::osc_host {

void PoseWriter::SetRig(const Rig& rig) noexcept {
  rig_ = &rig;
  turn_ = 0;
  Forget();
}

bool PoseWriter::Begin(const Pose& pose, std::size_t room) noexcept {
  if (rig_ == nullptr || room < kLeastRoom) return false;
  pose_ = &pose;
  room_ = room;
  at_ = taken_ = 0;
  ended_ = false;
  Plan();
  return true;
}

// How far the receiver's value is off, in steps; more than all of them while it has none.
std::uint32_t PoseWriter::ChangeOf(std::size_t channel) const noexcept {
  if (!known_[channel]) return 65536;
  const int change = pose_->values[channel] - sent_[channel];
  return static_cast<std::uint32_t>(change < 0 ? -change : change);
}

void PoseWriter::Plan() noexcept {
  const std::size_t count = std::min(pose_->values.size(), rig_->channels.size());
  const std::size_t in_turn = std::min(kInTurn, count);
  planned_ = 0;
  std::bitset<kMaxChannels> has;
  for (std::size_t i = 0; i < in_turn; ++i) {
    const std::size_t channel = (turn_ + i) % count;
    has[channel] = true;
    plan_[planned_++] = static_cast<std::uint8_t>(channel);
  }
  for (std::size_t channel = 0; channel < count; ++channel) {
    if (!has[channel] && ChangeOf(channel) > 0) {
      plan_[planned_++] = static_cast<std::uint8_t>(channel);
    }
  }
  std::sort(plan_.begin() + in_turn, plan_.begin() + planned_,
            [this](std::uint8_t a, std::uint8_t b) {
              const std::uint32_t change_a = ChangeOf(a);
              const std::uint32_t change_b = ChangeOf(b);
              return change_a != change_b ? change_a > change_b : a < b;
            });
}

Result<std::span<const std::byte>> PoseWriter::Next(std::span<std::byte> out) noexcept {
  for (; taken_ < at_; ++taken_) {
    const std::size_t channel = plan_[taken_];
    sent_[channel] = pose_->values[channel];
    known_[channel] = true;
    // The turn goes on from the last that got it.
    if (taken_ < kInTurn) turn_ = (channel + 1) % rig_->channels.size();
  }
  if (ended_) return Errc::kEnd;

  std::array<std::byte, kMaxPacketBytes> memory;  // NOLINT(*-member-init): written before read
  osc::Writer packet(memory);
  if (const Result<> begun = packet.Bundle(); !begun) return begun.error();
  bool full = false;
  const auto has_room = [&] { return packet.bytes().size() < room_; };
  for (; at_ < planned_ && !full && has_room(); at_ += full ? 0 : 1) {
    const std::size_t i = plan_[at_];
    const Channel& channel = rig_->channels[i];
    full = !packet.Message(ValueAddress(channel.name, channel.kind).view(),
                           Dequantise(pose_->values[i], channel.min, channel.max));
  }
  if (at_ == planned_ || !has_room()) {
    ended_ = packet
                 .Message("/facewire/pose", static_cast<std::int32_t>(pose_->frame_seq),
                          static_cast<std::int32_t>(pose_->state),
                          static_cast<float>(pose_->age_us) / 1000)
                 .has_value();
  }
  const auto frame = osc::Slip(packet.bytes(), out);
  if (frame) room_ -= std::min(room_, frame->size());
  return frame;
}

}  // namespace facewire::wire::osc_host
