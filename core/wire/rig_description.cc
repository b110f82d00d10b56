#include "core/wire/rig_description.h"

#include <bit>
#include <span>
#include <variant>

#include "core/wire/crc32.h"

namespace facewire::wire {

namespace {

// Not over finished frames: each ends in its own CRC, and a CRC over data and its CRC is the same
// number for any data.
class Digest {
 public:
  void Add(std::uint32_t value) noexcept {
    for (unsigned shift = 0; shift < 32; shift += 8)
      crc_.Add(static_cast<std::byte>(value >> shift));
  }
  void Add(float value) noexcept { Add(std::bit_cast<std::uint32_t>(value)); }
  void Add(const ShortName& name) noexcept {
    Add(static_cast<std::uint32_t>(name.view().size()));
    crc_.Add(std::as_bytes(std::span(name.view())));
  }
  std::uint32_t value() const noexcept { return crc_.value(); }

 private:
  Crc32 crc_;
};

}  // namespace

std::uint32_t RigId(const Rig& rig) noexcept {
  Digest digest;
  digest.Add(rig.name);
  digest.Add(static_cast<std::uint32_t>(rig.bones.size()));
  for (const Bone& bone : rig.bones) {
    digest.Add(bone.name);
    digest.Add(bone.rest_cm.x);
    digest.Add(bone.rest_cm.y);
    digest.Add(bone.rest_cm.z);
  }
  for (const Channel& c : rig.channels) {
    digest.Add(c.name);
    digest.Add(static_cast<std::uint32_t>(c.kind));
    digest.Add(static_cast<std::uint32_t>(c.bone));
    digest.Add(c.neutral);
    digest.Add(c.min);
    digest.Add(c.max);
  }
  return digest.value();
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
