#include "core/wire/rig_description.h"

#include <array>
#include <span>
#include <variant>

#include "core/wire/crc32.h"
#include "core/wire/encoder.h"

namespace facewire::wire {

std::uint32_t RigId(const Rig& rig) noexcept {
  // The CRC over the frames that describe the rig under the id 0, in order: whatever a host sees of
  // a rig counts, and nothing else. A part that cannot be described does not count.
  Encoder encoder;
  Crc32 crc;
  std::array<std::byte, kMaxDescriptionFrameBytes> buffer;
  for (std::size_t i = 0; i < DescriptionCount(rig); ++i) {
    const auto part = Description(rig, 0, i);
    if (!part) continue;
    if (const auto frame = encoder.Encode(*part, buffer)) crc.Add(*frame);
  }
  return crc.value();
}

Result<Message> Description(const Rig& rig, std::uint32_t rig_id, std::size_t index) noexcept {
  const std::size_t bones = rig.bones.size();
  if (index >= DescriptionCount(rig)) return Errc::kOutOfRange;
  if (index == 0) {
    return Message(RigHeader{.rig_id = rig_id,
                             .bones = static_cast<std::uint8_t>(bones),
                             .channels = static_cast<std::uint8_t>(rig.channels.size()),
                             .name = rig.name});
  }
  --index;
  if (index < bones) {
    const Bone& bone = rig.bones[index];
    return Message(BoneDescription{.rig_id = rig_id,
                                   .index = static_cast<std::uint8_t>(index),
                                   .name = bone.name,
                                   .rest_cm = bone.rest_cm});
  }
  index -= bones;
  const Channel& c = rig.channels[index];
  return Message(ChannelDescription{.rig_id = rig_id,
                                    .index = static_cast<std::uint8_t>(index),
                                    .name = c.name,
                                    .kind = c.kind,
                                    .bone = c.bone,
                                    .neutral = c.neutral,
                                    .min = c.min,
                                    .max = c.max});
}

bool RigCollector::Add(const Message& message) noexcept {
  if (const auto* header = std::get_if<RigHeader>(&message)) {
    if (!any_ || header->rig_id != rig_id_) StartOver(header->rig_id);
    // The decoder lets no count through that a rig has no room for; neither does this.
    if (header->bones > kMaxBones || header->channels > kMaxChannels) return false;
    rig_.name = header->name;
    (void)rig_.bones.try_resize(header->bones);
    (void)rig_.channels.try_resize(header->channels);
    has_header_ = true;
    return true;
  }
  if (const auto* part = std::get_if<BoneDescription>(&message)) {
    if (!any_ || part->rig_id != rig_id_) StartOver(part->rig_id);
    if (part->index >= rig_.bones.size()) return false;
    rig_.bones[part->index] = {.name = part->name, .rest_cm = part->rest_cm};
    has_bone_[part->index] = true;
    return true;
  }
  if (const auto* part = std::get_if<ChannelDescription>(&message)) {
    if (!any_ || part->rig_id != rig_id_) StartOver(part->rig_id);
    if (part->index >= rig_.channels.size()) return false;
    Channel& c = rig_.channels[part->index];
    c.name = part->name;
    c.kind = part->kind;
    c.bone = part->bone;
    c.neutral = part->neutral;
    c.min = part->min;
    c.max = part->max;
    has_channel_[part->index] = true;
    return true;
  }
  return false;
}

// Until the header says how many there are, there is room for all of them.
void RigCollector::StartOver(std::uint32_t rig_id) noexcept {
  rig_id_ = rig_id;
  any_ = true;
  has_header_ = false;
  has_bone_.reset();
  has_channel_.reset();
  (void)rig_.bones.try_resize(kMaxBones);
  (void)rig_.channels.try_resize(kMaxChannels);
}

bool RigCollector::Complete() const noexcept { return missing() == 0; }

std::size_t RigCollector::missing() const noexcept {
  if (!has_header_) return 1;
  std::size_t missing = 0;
  for (std::size_t i = 0; i < rig_.bones.size(); ++i) missing += has_bone_[i] ? 0 : 1;
  for (std::size_t i = 0; i < rig_.channels.size(); ++i) missing += has_channel_[i] ? 0 : 1;
  return missing;
}

}  // namespace facewire::wire
