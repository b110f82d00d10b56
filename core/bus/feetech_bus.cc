#include "core/bus/feetech_bus.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/bus/fault_bits.h"

namespace facewire::bus {
namespace {

namespace ft = wire::feetech;
namespace sts = wire::feetech::sts;

constexpr std::size_t kStatusFrame = 6;    // FF FF id length errors ... sum
constexpr std::uint8_t kCoarseSpeed = 50;  // counts/s
constexpr float kAccelerationUnit = 100;   // counts/s^2

struct Range {
  std::uint8_t address;
  std::uint8_t bytes;
};
constexpr Range Span(ft::Register first, ft::Register last) noexcept {
  return {first.address, static_cast<std::uint8_t>(last.address + last.bytes - first.address)};
}

template <class Block>
constexpr Range RangeOf(Block block) noexcept {
  switch (block) {
    case Block::kSettings:
      return Span(sts::kModel, sts::kMode);
    case Block::kHealth:
      return Span(sts::kTorqueEnable, sts::kLock);
    case Block::kStatus:
      return Span(sts::kPresentPosition, sts::kStatus);
  }
  return {};
}

std::span<const std::byte> Part(std::span<const std::byte> data, Range from,
                                ft::Register what) noexcept {
  return data.subspan(static_cast<std::size_t>(what.address - from.address), what.bytes);
}
std::uint8_t Get8(std::span<const std::byte> data, Range from, ft::Register what) noexcept {
  return std::to_integer<std::uint8_t>(Part(data, from, what)[0]);
}

// The register's value for a rate; the reset value of servos for what is not in their list.
constexpr std::array<std::uint32_t, 8> kRates = {1'000'000, 500'000, 250'000, 128'000,
                                                 115'200,   76'800,  57'600,  38'400};

constexpr std::array<FaultPair<ft::ServoError>, 5> kFaults = {{
    {ft::ServoError::kVoltage, HardwareFault::kVoltage},
    {ft::ServoError::kEncoder, HardwareFault::kEncoder},
    {ft::ServoError::kHeat, HardwareFault::kHeat},
    {ft::ServoError::kCurrent, HardwareFault::kCurrent},
    {ft::ServoError::kOverload, HardwareFault::kOverload},
}};

std::size_t SizeOf(const ft::Packet& packet) noexcept { return packet ? packet->size() : 0; }

}  // namespace

Result<> FeetechBus::Configure(const FeetechConfig& config) noexcept {
  if (config.full_speed < 1 || config.full_speed > 32767) return Errc::kOutOfRange;
  const auto done = ConfigureChain(config.bus, ft::kMaxId);
  if (!done) return done;
  feetech_ = config;
  counts_per_speed_.fill(1);
  return {};
}

std::uint16_t FeetechBus::SpeedOf(std::size_t servo, bool slow) const noexcept {
  const ServoConfig& wanted = config().servos[servo];
  const auto speed =
      static_cast<std::int32_t>(slow ? wanted.arrive_speed_per_s : wanted.top_speed_per_s);
  if (speed == 0) return static_cast<std::uint16_t>(feetech_.full_speed);
  // Never 0, which may mean full speed; rounded down, as it is a limit.
  return static_cast<std::uint16_t>(
      std::clamp(speed / counts_per_speed_[servo], 1, feetech_.full_speed));
}

std::uint8_t FeetechBus::AccelerationOf(std::size_t servo, bool slow) const noexcept {
  const float arriving = config().servos[servo].arrive_acceleration_per_s2;
  if (!slow || arriving <= 0) return feetech_.acceleration;
  return static_cast<std::uint8_t>(std::clamp(arriving / kAccelerationUnit, 1.0F, 254.0F));
}

std::size_t FeetechBus::MakeGoals(std::span<const Goal> goals, std::span<std::byte> out) noexcept {
  // acceleration, position, time, speed; SCS servos have no acceleration.
  const std::uint8_t first = sts() ? sts::kAcceleration.address : sts::kGoalPosition.address;
  const std::uint8_t skip = sts() ? 0 : 1;
  const auto length = static_cast<std::uint8_t>(7 - skip);
  std::size_t used = 0;
  while (!goals.empty()) {
    ft::SyncWrite write(first, length, out.subspan(used));
    while (!goals.empty()) {
      const Goal& goal = goals.front();
      std::array<std::byte, 7> record{};
      record[0] = static_cast<std::byte>(AccelerationOf(goal.servo, goal.slow));
      ft::Put16(ft::ToSignMagnitude(goal.counts, ft::kPositionSign), order(),
                std::span(record).subspan(1));
      ft::Put16(SpeedOf(goal.servo, goal.slow), order(), std::span(record).subspan(5));
      if (!write.Add(goal.id, std::span(record).subspan(skip))) break;
      goals = goals.subspan(1);
    }
    const std::size_t size = SizeOf(write.Finish());
    if (size == 0) break;
    used += size;
  }
  return used;
}

std::size_t FeetechBus::MakeArming(const Goal& goal, std::span<std::byte> out) noexcept {
  return MakeGoals(std::span(&goal, 1), out);
}

// Every goal carries its pace.
std::size_t FeetechBus::MakePace(const Goal& /*goal*/, std::span<std::byte> /*out*/) noexcept {
  return 0;
}

std::size_t FeetechBus::MakeTorque(std::span<const std::uint8_t> ids, bool on,
                                   std::span<std::byte> out) noexcept {
  ft::SyncWrite write(sts::kTorqueEnable.address, sts::kTorqueEnable.bytes, out);
  const std::array value = {std::byte{on}};
  for (std::uint8_t id : ids) (void)write.Add(id, value);  // 125 servos fit
  return SizeOf(write.Finish());
}

std::size_t FeetechBus::MakeRelease(std::span<std::byte> out) noexcept {
  const std::array off = {std::byte{0}};
  return SizeOf(ft::Write(ft::kBroadcast, sts::kTorqueEnable.address, off, out));
}

std::size_t FeetechBus::MakeReboot(std::uint8_t id, std::span<std::byte> out) noexcept {
  return SizeOf(ft::Reboot(id, out));
}

std::size_t FeetechBus::MakeQuestion(Block block, std::size_t /*part*/,
                                     std::span<const std::uint8_t> ids,
                                     std::span<std::byte> out) noexcept {
  const Range range = RangeOf(block);
  (void)reader_.Expect(ids, range.bytes);  // all blocks are shorter than it can read
  if (ids.size() == 1) return SizeOf(ft::Read(ids[0], range.address, range.bytes, out));
  return SizeOf(ft::SyncRead(range.address, range.bytes, ids, out));
}

std::optional<ChainBus::Answer> FeetechBus::NextAnswer(std::span<const std::byte>& bytes) noexcept {
  const auto status = reader_.Next(bytes);
  if (!status) return std::nullopt;
  errors_ = status->errors;
  return Answer{.id = status->id, .good = true, .alert = false, .data = status->parameters};
}

std::size_t FeetechBus::AnswerBytes(Block block, std::size_t /*part*/) const noexcept {
  return kStatusFrame + RangeOf(block).bytes;
}

bool FeetechBus::TakeSettings(std::size_t servo, std::size_t /*part*/,
                              std::span<const std::byte> data) noexcept {
  const Range from = RangeOf(Block::kSettings);
  const ServoConfig& wanted = config().servos[servo];
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
  const std::int32_t min = ft::Get16(Part(data, from, sts::kMinAngle), order());
  const std::int32_t max = ft::Get16(Part(data, from, sts::kMaxAngle), order());
  const auto low = static_cast<std::int32_t>(std::ceil(wanted.min));
  const auto high = static_cast<std::int32_t>(std::floor(wanted.max));
  // Both 0: it turns without end, and goals mean something else.
  const bool endless = min == 0 && max == 0;
  compare(Setting::kMinPosition, min, low, min == low && !endless, endless);
  compare(Setting::kMaxPosition, max, high, max == high && !endless, endless);
  const auto rate = std::ranges::find(kRates, config().baud);
  const std::int32_t baud = Get8(data, from, sts::kBaudRate);
  const auto want_baud = static_cast<std::int32_t>(rate - kRates.begin());
  compare(Setting::kBaudRate, baud, want_baud, rate == kRates.end() || baud == want_baud, false);
  if (sts()) {
    const std::int32_t mode = Get8(data, from, sts::kMode);
    compare(Setting::kOperatingMode, mode, 0, mode == 0, true);
    const HardwareFaults shutdown = FaultsFrom(kFaults, Get8(data, from, sts::kUnload));
    compare(Setting::kShutdown, shutdown, feetech_.shutdown,
            (feetech_.shutdown & ~unsigned{shutdown}) == 0, false);
    const bool fine = (Get8(data, from, sts::kPhase) & ft::kPhaseFineSpeed) != 0;
    counts_per_speed_[servo] = fine ? 1 : kCoarseSpeed;
  }
  return usable;
}

void FeetechBus::TakeHealth(std::size_t servo, std::size_t /*part*/,
                            std::span<const std::byte> data, Health& health) noexcept {
  const Range from = RangeOf(Block::kHealth);
  const std::uint16_t speed = ft::Get16(Part(data, from, sts::kGoalSpeed), order());
  const std::int32_t lock = Get8(data, from, sts() ? sts::kLock : ft::scs::kLock);
  Compare({.servo = static_cast<std::uint8_t>(servo),
           .setting = Setting::kLock,
           .found = lock,
           .wanted = 1,
           .refused = false},
          lock == 1);
  health = {.torque = Get8(data, from, sts::kTorqueEnable) != 0,
            .goal = ft::FromSignMagnitude(ft::Get16(Part(data, from, sts::kGoalPosition), order()),
                                          ft::kPositionSign),
            .slow = speed == SpeedOf(servo, true),
            .normal = speed == SpeedOf(servo, false),
            .watched = true,
            .faults = FaultsFrom(kFaults, errors_)};
}

ChainBus::Reading FeetechBus::TakeStatus(std::size_t /*servo*/,
                                         std::span<const std::byte> data) noexcept {
  const Range from = RangeOf(Block::kStatus);
  const std::uint16_t load = ft::Get16(Part(data, from, sts::kPresentLoad), order());
  return {.position = ft::FromSignMagnitude(
              ft::Get16(Part(data, from, sts::kPresentPosition), order()), ft::kPositionSign),
          .temperature_c = Get8(data, from, sts::kPresentTemperature),
          .load = static_cast<float>(ft::FromSignMagnitude(load, ft::kLoadSign)) * 1e-3F,
          .voltage_v = static_cast<float>(Get8(data, from, sts::kPresentVoltage)) * 0.1F,
          .faults = FaultsFrom(kFaults, errors_)};
}

Result<FeetechBus::SettingPackets> FeetechBus::MakeSetting(FeetechSeries series, std::uint8_t id,
                                                           Setting setting, std::int32_t value,
                                                           std::span<std::byte> out) noexcept {
  const bool is_sts = series == FeetechSeries::kSts;
  ft::Register what;
  std::int32_t most = 0;
  std::int32_t raw = value;
  switch (setting) {
    case Setting::kMinPosition:
    case Setting::kMaxPosition:
      what = setting == Setting::kMinPosition ? sts::kMinAngle : sts::kMaxAngle;
      most = is_sts ? ft::kCountsPerTurn - 1 : 1023;
      break;
    case Setting::kBaudRate:
      what = sts::kBaudRate;
      most = static_cast<std::int32_t>(kRates.size()) - 1;
      break;
    case Setting::kOperatingMode:
      if (!is_sts) return Errc::kUnsupported;
      what = sts::kMode;
      most = static_cast<std::int32_t>(ft::Mode::kStep);
      break;
    case Setting::kShutdown:
      if (!is_sts) return Errc::kUnsupported;
      what = sts::kUnload;
      most = 0x3F;
      raw = FaultsTo(kFaults, static_cast<HardwareFaults>(value));
      break;
    case Setting::kReturnDelay:
    case Setting::kProfileUnit:
    case Setting::kLock:
    case Setting::kPulseRange:
    case Setting::kSerialErrors:
    case Setting::kOutputs:
      return Errc::kUnsupported;
  }
  if (id > ft::kMaxId || value < 0 || value > most) return Errc::kOutOfRange;
  const std::uint8_t lock = is_sts ? sts::kLock.address : ft::scs::kLock.address;
  const std::array open = {std::byte{0}};
  const std::array closed = {std::byte{1}};
  std::array<std::byte, 2> data{};
  if (what.bytes == 1) {
    data[0] = static_cast<std::byte>(raw);
  } else {
    ft::Put16(static_cast<std::uint16_t>(raw),
              is_sts ? ft::ByteOrder::kLowFirst : ft::ByteOrder::kHighFirst, data);
  }
  SettingPackets packets;
  const auto unlock = ft::Write(id, lock, open, out);
  if (!unlock) return unlock.error();
  packets.unlock = *unlock;
  out = out.subspan(unlock->size());
  const auto write = ft::Write(id, what.address, std::span(data).first(what.bytes), out);
  if (!write) return write.error();
  packets.write = *write;
  const auto lock_again = ft::Write(id, lock, closed, out.subspan(write->size()));
  if (!lock_again) return lock_again.error();
  packets.lock = *lock_again;
  return packets;
}

}  // namespace facewire::bus
