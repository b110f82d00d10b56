#include "core/wire/osc_host/encoder.h"

#include <array>
#include <string_view>
#include <variant>

#include "core/wire/osc/osc.h"
#include "core/wire/osc/slip.h"
#include "core/wire/osc_host/address.h"
#include "core/wire/osc_host/command.h"

namespace facewire::wire::osc_host {
namespace {

using std::string_view;

// OSC's integers are signed; what counts further wraps, as on every line.
std::int32_t Integer(std::uint32_t value) noexcept { return static_cast<std::int32_t>(value); }
float Milliseconds(std::uint32_t us) noexcept { return static_cast<float>(us) / 1000; }

string_view UnitOf(ChannelKind kind) noexcept {
  if (IsPosition(kind)) return "cm";
  return IsRotation(kind) ? "deg" : "";
}

template <class... Args>
Result<std::span<const std::byte>> Packet(std::span<std::byte> out, string_view address,
                                          const Args&... args) noexcept {
  std::array<std::byte, kMaxPacketBytes> memory;  // NOLINT(*-member-init): written before read
  osc::Writer packet(memory);
  if (const Result<> added = packet.Message(address, args...); !added) return added.error();
  return osc::Slip(packet.bytes(), out);
}

}  // namespace

Result<std::span<const std::byte>> Encode(const RigHeader& m, std::span<std::byte> out) noexcept {
  return Packet(out, "/facewire/rig", m.name.view(), std::int32_t{m.bones},
                std::int32_t{m.channels}, Integer(m.rig_id));
}

Result<std::span<const std::byte>> Encode(const BoneDescription& m,
                                          std::span<std::byte> out) noexcept {
  return Packet(out, "/facewire/bone", std::int32_t{m.index}, m.name.view(), m.rest_cm.x,
                m.rest_cm.y, m.rest_cm.z);
}

Result<std::span<const std::byte>> Encode(const ChannelDescription& m,
                                          std::span<std::byte> out) noexcept {
  return Packet(out, "/facewire/channel", std::int32_t{m.index},
                ValueAddress(m.name, m.kind).view(), m.min, m.max, m.neutral, UnitOf(m.kind));
}

Result<std::span<const std::byte>> Encode(const Status& m, std::span<std::byte> out) noexcept {
  return Packet(out, "/facewire/status", string_view(Name(m.state)),
                static_cast<float>(m.centi_fps) / 100, Integer(m.uptime_s), Integer(m.frames),
                Integer(m.dropped), Integer(m.losses), Integer(m.link_errors),
                Milliseconds(m.latency_p50_us), Milliseconds(m.latency_p99_us));
}

Result<std::span<const std::byte>> Encode(const Acknowledgement& m,
                                          std::span<std::byte> out) noexcept {
  return Packet(out, "/facewire/answer", string_view(Name(m.code)), string_view(Name(m.result)),
                m.measure);
}

Result<std::span<const std::byte>> Encode(const Message& message,
                                          std::span<std::byte> out) noexcept {
  if (const auto* m = std::get_if<RigHeader>(&message)) return Encode(*m, out);
  if (const auto* m = std::get_if<BoneDescription>(&message)) return Encode(*m, out);
  if (const auto* m = std::get_if<ChannelDescription>(&message)) return Encode(*m, out);
  if (const auto* m = std::get_if<Status>(&message)) return Encode(*m, out);
  if (const auto* m = std::get_if<Acknowledgement>(&message)) return Encode(*m, out);
  return Errc::kUnsupported;
}

}  // namespace facewire::wire::osc_host
