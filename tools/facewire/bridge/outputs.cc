#include "tools/facewire/bridge/outputs.h"

#include <array>
#include <cstdio>

#include "core/wire/livelink/livelink.h"

namespace facewire::tools {
namespace {

bool Tracking(const FaceMoment& moment) { return moment.state == ServiceState::kTracking; }

// Whether a face, or the loss of one, still moves the rig.
bool Moves(ServiceState state) {
  return state == ServiceState::kTracking || state == ServiceState::kHolding ||
         state == ServiceState::kEasing || state == ServiceState::kFault;
}

}  // namespace

void VmcOutput::Send(const FaceMoment& moment) {
  std::array<std::byte, wire::vmc::kMaxPacketBytes> buffer;
  wire::vmc::FramePackets packets(
      names_, {.face = moment.face, .tracking = Tracking(moment), .elapsed_s = moment.elapsed_s});
  while (const auto packet = packets.Next(buffer)) sender_.Send(*packet);
}

void LiveLinkOutput::Begin(const Rig& rig, std::uint32_t rig_id) {
  name_ = !wanted_name_.empty() ? wanted_name_ : std::string(rig.name.view());
  if (name_.empty()) name_ = "facewire";
  // Like an UUID, because receivers count on its 36 characters; "facewire" in hexadecimal, and the
  // rig's number.
  std::array<char, 37> id{};
  std::snprintf(id.data(), id.size(), "66616365-7769-7265-0000-%012lx",
                static_cast<unsigned long>(rig_id));
  device_id_ = id.data();
}

void LiveLinkOutput::Send(const FaceMoment& moment) {
  const bool moves = Moves(moment.state);
  // The first pose at rest still has its values: receivers keep the last.
  const bool has_values = moves || moved_;
  moved_ = moves;
  std::array<std::byte, wire::livelink::kMaxPacketBytes> buffer;
  const auto packet =
      wire::livelink::Encode({.device_id = device_id_, .name = name_}, moment.captured,
                             has_values ? &moment.face : nullptr, buffer);
  if (packet) sender_.Send(*packet);
}

void IFacialMocapOutput::Send(const FaceMoment& moment) {
  std::array<std::byte, wire::ifacialmocap::kMaxPacketBytes> buffer;
  const auto packet = wire::ifacialmocap::Encode(version_, moment.face, Tracking(moment), buffer);
  if (packet) sender_.Send(*packet);
}

}  // namespace facewire::tools
