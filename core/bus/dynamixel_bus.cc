#include "core/bus/dynamixel_bus.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/bus/fault_bits.h"

namespace facewire::bus {
namespace {

namespace dxl = wire::dynamixel;
namespace x = wire::dynamixel::x;

constexpr Duration kWatchdogUnit = std::chrono::milliseconds(20);
constexpr unsigned kTimeProfile = 1U << 2U;  // of the drive mode
// 0.229 rev/min in counts/s.
constexpr float kCountsPerSpeed = 0.229F * dxl::kCountsPerTurn / 60;
// 214.577 rev/min^2 in counts/s^2.
constexpr float kCountsPerAcceleration = 214.577F * dxl::kCountsPerTurn / 3600;
constexpr dxl::Register kProfile{x::kProfileAcceleration.address,
                                 x::kProfileAcceleration.bytes + x::kProfileVelocity.bytes};
constexpr std::size_t kStatusFrame = 11;  // FF FF FD 00 id length 55 error ... CRC

struct Range {
  std::uint16_t address;
  std::uint16_t bytes;
};
constexpr Range Span(dxl::Register first, dxl::Register last) noexcept {
  return {first.address, static_cast<std::uint16_t>(last.address + last.bytes - first.address)};
}

// Reading what no table names is an error, so each block has as many parts as there are gaps.
constexpr std::array kSettings = {
    Span(x::kReturnDelay, x::kOperatingMode), Span(x::kMaxPosition, x::kMinPosition),
    Span(x::kShutdown, x::kShutdown), Span(x::kCurrentLimit, x::kCurrentLimit)};
constexpr std::size_t kCurrentPart = 3;
constexpr std::array kHealth = {
    Span(x::kTorqueEnable, x::kTorqueEnable), Span(x::kHardwareError, x::kHardwareError),
    Span(x::kBusWatchdog, x::kBusWatchdog), Span(x::kProfileAcceleration, x::kGoalPosition)};
constexpr Range kStatus = Span(x::kPresentLoad, x::kPresentTemperature);

template <class Block>
constexpr Range RangeOf(Block block, std::size_t part) noexcept {
  switch (block) {
    case Block::kSettings:
      return kSettings[part];
    case Block::kHealth:
      return kHealth[part];
    case Block::kStatus:
      return kStatus;
  }
  return {};
}

// Little-endian value of `what` in data that begins at `from`.
std::uint32_t Get(std::span<const std::byte> data, Range from, dxl::Register what) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < what.bytes; ++i) {
    value |= std::to_integer<std::uint32_t>(data[what.address - from.address + i]) << (8 * i);
  }
  return value;
}

std::array<std::byte, 4> Bytes(std::uint32_t value) noexcept {
  std::array<std::byte, 4> bytes{};
  for (std::byte& b : bytes) {
    b = static_cast<std::byte>(value & 0xFFU);
    value >>= 8U;
  }
  return bytes;
}

// At least one step: 0 would be unlimited.
std::uint32_t Steps(float value, float step) noexcept {
  return static_cast<std::uint32_t>(std::max(1L, std::lround(value / step)));
}

constexpr std::array<FaultPair<dxl::HardwareError>, 5> kFaults = {{
    {dxl::HardwareError::kVoltage, HardwareFault::kVoltage},
    {dxl::HardwareError::kHeat, HardwareFault::kHeat},
    {dxl::HardwareError::kEncoder, HardwareFault::kEncoder},
    {dxl::HardwareError::kShock, HardwareFault::kShock},
    {dxl::HardwareError::kOverload, HardwareFault::kOverload},
}};

std::size_t SizeOf(const dxl::Packet& packet) noexcept { return packet ? packet->size() : 0; }

// One register of one servo, without a reply.
std::size_t Tell(std::uint8_t id, dxl::Register what, std::span<const std::byte> value,
                 std::span<std::byte> out) noexcept {
  dxl::SyncWrite write(what.address, what.bytes, out);
  (void)write.Add(id, value.first(what.bytes));
  return SizeOf(write.Finish());
}
std::size_t Tell(std::uint8_t id, dxl::Register what, std::uint32_t value,
                 std::span<std::byte> out) noexcept {
  return Tell(id, what, Bytes(value), out);
}

}  // namespace

Result<> DynamixelBus::Configure(const DynamixelConfig& config) noexcept {
  const auto units = config.watchdog / kWatchdogUnit;
  if (units < 1 || units > dxl::kMaxWatchdog || config.watchdog < 3 * config.bus.refresh) {
    return Errc::kOutOfRange;
  }
  const auto done = ConfigureChain(config.bus, dxl::kMaxId);
  if (!done) return done;
  dynamixel_ = config;
  full_current_.fill(0);
  return {};
}

std::size_t DynamixelBus::MakeGoals(std::span<const Goal> goals,
                                    std::span<std::byte> out) noexcept {
  dxl::SyncWrite write(x::kGoalPosition.address, x::kGoalPosition.bytes, out);
  for (const Goal& goal : goals) {
    (void)write.Add(goal.id, Bytes(std::bit_cast<std::uint32_t>(goal.counts)));
  }
  return SizeOf(write.Finish());
}

std::size_t DynamixelBus::MakeArming(const Goal& goal, std::span<std::byte> out) noexcept {
  const auto units = static_cast<std::uint32_t>(dynamixel_.watchdog / kWatchdogUnit);
  // A watchdog that has tripped keeps the goal from being written until it is cleared.
  std::size_t used = Tell(goal.id, x::kBusWatchdog, 0, out);
  used += Tell(goal.id, kProfile, ProfileOf(goal.servo, goal.slow), out.subspan(used));
  used +=
      Tell(goal.id, x::kGoalPosition, std::bit_cast<std::uint32_t>(goal.counts), out.subspan(used));
  used += Tell(goal.id, x::kBusWatchdog, units, out.subspan(used));
  return used;
}

std::size_t DynamixelBus::MakePace(const Goal& goal, std::span<std::byte> out) noexcept {
  return Tell(goal.id, kProfile, ProfileOf(goal.servo, goal.slow), out);
}

std::array<std::byte, 8> DynamixelBus::ProfileOf(std::size_t servo, bool slow) const noexcept {
  std::array<std::byte, 8> profile{};  // zeros: no limits
  const ServoConfig& config = this->config().servos[servo];
  const float acceleration = slow ? config.arrive_acceleration_per_s2 : 0;
  const float speed = slow ? config.arrive_speed_per_s : config.top_speed_per_s;
  if (acceleration > 0) {
    std::ranges::copy(Bytes(Steps(acceleration, kCountsPerAcceleration)), profile.begin());
  }
  if (speed > 0) std::ranges::copy(Bytes(Steps(speed, kCountsPerSpeed)), profile.begin() + 4);
  return profile;
}

std::size_t DynamixelBus::MakeTorque(std::span<const std::uint8_t> ids, bool on,
                                     std::span<std::byte> out) noexcept {
  dxl::SyncWrite write(x::kTorqueEnable.address, x::kTorqueEnable.bytes, out);
  const std::array value = {std::byte{on}};
  for (std::uint8_t id : ids) (void)write.Add(id, value);
  return SizeOf(write.Finish());
}

std::size_t DynamixelBus::MakeRelease(std::span<std::byte> out) noexcept {
  const std::array off = {std::byte{0}};
  return SizeOf(dxl::Write(dxl::kBroadcast, x::kTorqueEnable.address, off, out));
}

std::size_t DynamixelBus::MakeReboot(std::uint8_t id, std::span<std::byte> out) noexcept {
  return SizeOf(dxl::Reboot(id, out));
}

std::size_t DynamixelBus::MakeQuestion(Block block, std::size_t part,
                                       std::span<const std::uint8_t> ids,
                                       std::span<std::byte> out) noexcept {
  const Range range = RangeOf(block, part);
  wanted_bytes_ = range.bytes;
  optional_ = block == Block::kSettings && part == kCurrentPart;
  reader_.Reset();
  if (ids.size() == 1) return SizeOf(dxl::Read(ids[0], range.address, range.bytes, out));
  return SizeOf(dxl::SyncRead(range.address, range.bytes, ids, out));
}

std::optional<ChainBus::Answer> DynamixelBus::NextAnswer(
    std::span<const std::byte>& bytes) noexcept {
  const auto status = reader_.Next(bytes);
  if (!status) return std::nullopt;
  const bool read =
      status->error == dxl::StatusError::kNone && status->parameters.size() == wanted_bytes_;
  const bool has_none = optional_ && status->error == dxl::StatusError::kAccess;
  return Answer{.id = status->id,
                .good = read || has_none,
                .alert = status->alert,
                .data = read ? status->parameters : std::span<const std::byte>()};
}

std::size_t DynamixelBus::Parts(Block block) const noexcept {
  switch (block) {
    case Block::kSettings:
      return kSettings.size();
    case Block::kHealth:
      return kHealth.size();
    case Block::kStatus:
      return 1;
  }
  return 1;
}

std::size_t DynamixelBus::AnswerBytes(Block block, std::size_t part) const noexcept {
  return kStatusFrame + RangeOf(block, part).bytes;
}

bool DynamixelBus::TakeSettings(std::size_t servo, std::size_t part,
                                std::span<const std::byte> data) noexcept {
  if (part == kCurrentPart) {
    const std::uint32_t full = data.empty() ? 0 : Get(data, kSettings[part], x::kCurrentLimit);
    full_current_[servo] = static_cast<std::uint16_t>(full);
    return true;
  }
  bool usable = true;
  const auto compare = [&](Setting setting, std::int32_t found, std::int32_t want, bool fine,
                           bool refuse) {
    Compare({.servo = static_cast<std::uint8_t>(servo),
             .setting = setting,
             .found = found,
             .wanted = want,
             .refused = refuse},
            fine);
    usable = usable && (fine || !refuse);
  };
  const auto get = [&](dxl::Register what) {
    return std::bit_cast<std::int32_t>(Get(data, kSettings[part], what));
  };
  switch (part) {
    case 0: {
      const std::int32_t mode = get(x::kOperatingMode);
      const auto want_mode = static_cast<std::int32_t>(dynamixel_.mode);
      compare(Setting::kOperatingMode, mode, want_mode, mode == want_mode, true);
      const bool timed = (static_cast<unsigned>(get(x::kDriveMode)) & kTimeProfile) != 0;
      compare(Setting::kProfileUnit, timed ? 1 : 0, 0, !timed, true);
      const std::int32_t delay_us = get(x::kReturnDelay) * 2;
      const auto most_us = static_cast<std::int32_t>(dynamixel_.max_return_delay.count());
      compare(Setting::kReturnDelay, delay_us, most_us, delay_us <= most_us, false);
      break;
    }
    case 1: {
      // The servo's own limits are the last to hold when all else fails: they should be the rig's.
      const ServoConfig& wanted = config().servos[servo];
      const auto low = static_cast<std::int32_t>(std::ceil(wanted.min));
      const auto high = static_cast<std::int32_t>(std::floor(wanted.max));
      const std::int32_t min = get(x::kMinPosition);
      const std::int32_t max = get(x::kMaxPosition);
      compare(Setting::kMinPosition, min, low, min == low, false);
      compare(Setting::kMaxPosition, max, high, max == high, false);
      break;
    }
    default: {
      const HardwareFaults shutdown = FaultsFrom(kFaults, Get(data, kSettings[part], x::kShutdown));
      compare(Setting::kShutdown, shutdown, dynamixel_.shutdown,
              (dynamixel_.shutdown & ~unsigned{shutdown}) == 0, false);
      break;
    }
  }
  return usable;
}

void DynamixelBus::TakeHealth(std::size_t servo, std::size_t part, std::span<const std::byte> data,
                              Health& health) noexcept {
  const Range from = kHealth[part];
  const auto units = static_cast<std::uint32_t>(dynamixel_.watchdog / kWatchdogUnit);
  switch (part) {
    case 0:
      health.torque = Get(data, from, x::kTorqueEnable) != 0;
      return;
    case 1:
      health.faults = FaultsFrom(kFaults, Get(data, from, x::kHardwareError));
      return;
    case 2:
      health.watched = Get(data, from, x::kBusWatchdog) == units;
      return;
    default:
      health.goal = std::bit_cast<std::int32_t>(Get(data, from, x::kGoalPosition));
      health.slow = std::ranges::equal(data.first(kProfile.bytes), ProfileOf(servo, true));
      health.normal = std::ranges::equal(data.first(kProfile.bytes), ProfileOf(servo, false));
      return;
  }
}

ChainBus::Reading DynamixelBus::TakeStatus(std::size_t servo,
                                           std::span<const std::byte> data) noexcept {
  const auto load = static_cast<std::int16_t>(Get(data, kStatus, x::kPresentLoad));
  const auto full = full_current_[servo] != 0 ? static_cast<float>(full_current_[servo]) : 1000.0F;
  return {.position = std::bit_cast<std::int32_t>(Get(data, kStatus, x::kPresentPosition)),
          .temperature_c = static_cast<float>(Get(data, kStatus, x::kPresentTemperature)),
          .load = static_cast<float>(load) / full,
          .voltage_v = static_cast<float>(Get(data, kStatus, x::kPresentVoltage)) * 0.1F,
          .faults = std::nullopt};
}

Result<std::span<const std::byte>> DynamixelBus::MakeSetting(std::uint8_t id, Setting setting,
                                                             std::int32_t value,
                                                             std::span<std::byte> out) noexcept {
  const auto write = [&](dxl::Register what, std::int32_t least, std::int32_t most,
                         std::uint32_t raw) -> Result<std::span<const std::byte>> {
    if (id > dxl::kMaxId || value < least || value > most) return Errc::kOutOfRange;
    const auto bytes = Bytes(raw);
    return dxl::Write(id, what.address, std::span(bytes).first(what.bytes), out);
  };
  const auto raw = static_cast<std::uint32_t>(value);
  switch (setting) {
    case Setting::kOperatingMode:
      return write(x::kOperatingMode, 0, 16, raw);
    case Setting::kMinPosition:
      return write(x::kMinPosition, 0, dxl::kCountsPerTurn - 1, raw);
    case Setting::kMaxPosition:
      return write(x::kMaxPosition, 0, dxl::kCountsPerTurn - 1, raw);
    case Setting::kShutdown:
      return write(x::kShutdown, 0, 0x1F, FaultsTo(kFaults, static_cast<HardwareFaults>(value)));
    case Setting::kReturnDelay:
      return write(x::kReturnDelay, 0, 508, raw / 2);
    case Setting::kBaudRate:
      return write(x::kBaudRate, 0, 7, raw);
    case Setting::kProfileUnit:
    case Setting::kLock:
    case Setting::kPulseRange:
    case Setting::kSerialErrors:
    case Setting::kOutputs:
      return Errc::kUnsupported;
  }
  return Errc::kUnsupported;
}

}  // namespace facewire::bus
