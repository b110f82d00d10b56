#include "tools/facewire/servo/eeprom_chain.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>

#include "app/error.h"
#include "core/bus/dynamixel_bus.h"
#include "core/bus/feetech_bus.h"
#include "core/wire/dynamixel/packet.h"
#include "core/wire/feetech/packet.h"
#include "tools/facewire/servo/dynamixel_line.h"
#include "tools/facewire/servo/feetech_line.h"
#include "tools/facewire/servo/setting_value.h"

namespace facewire::tools {
namespace {

namespace dxl = wire::dynamixel;
namespace ft = wire::feetech;
using bus::Setting;

// The servo writes, and who has another id or rate now says so where nobody listens.
constexpr std::chrono::milliseconds kSettles(50);

constexpr std::string_view kSettings =
    "mode, min-position, max-position, shutdown, lock, "
    "return-delay, profile-unit, id or baud";

// Codes of the rates: the place in these lists.
constexpr std::array kDynamixelRates = {9600,      57'600,    115'200,  1'000'000,
                                        2'000'000, 3'000'000, 4'000'000};
constexpr std::array kFeetechRates = {1'000'000, 500'000, 250'000, 128'000,
                                      115'200,   76'800,  57'600,  38'400};
constexpr std::uint32_t kTimeProfile = 1U << 2U;  // of a Dynamixel's drive mode

using Buffer = std::array<std::byte, dxl::kMaxPacketBytes>;

std::vector<std::byte> Kept(std::span<const std::byte> bytes) {
  return {bytes.begin(), bytes.end()};
}

[[noreturn]] void RefuseValue(std::string_view setting, std::string_view value) {
  throw app::BadInput("\"" + std::string(value) + "\" is no " + std::string(setting) +
                      " for this servo; `facewire servo list` names settings as they should be");
}
[[noreturn]] void RefuseSetting(std::string_view setting) {
  throw app::BadInput("servos of this kind have no setting \"" + std::string(setting) +
                      "\"; expected " + std::string(kSettings));
}

std::uint8_t IdOf(std::string_view value, std::uint8_t most) {
  const auto id = WholeNumber(value);
  if (!id || *id < 0 || *id > most) {
    throw app::BadInput("\"" + std::string(value) + "\" is no id; expected 0 to " +
                        std::to_string(most));
  }
  return static_cast<std::uint8_t>(*id);
}

template <std::size_t kCount>
std::int32_t RateCode(const std::array<int, kCount>& rates, std::string_view value) {
  const auto rate = WholeNumber(value);
  const auto found = rate ? std::ranges::find(rates, *rate) : rates.end();
  if (found != rates.end()) return static_cast<std::int32_t>(found - rates.begin());
  std::string known;
  for (const int one : rates) known += (known.empty() ? "" : ", ") + std::to_string(one);
  throw app::BadInput("\"" + std::string(value) + "\" is no rate of this servo; expected one of " +
                      known);
}

class DynamixelChain final : public EepromChain {
 public:
  explicit DynamixelChain(Line& line) : line_(line), chain_(line) {}

  bool Finds(std::uint8_t id) override { return chain_.Read(id, dxl::x::kModel).has_value(); }

  EepromItem Make(std::uint8_t id, std::string_view setting, std::string_view value) override {
    if (setting == "id") {
      const std::uint8_t to = IdOf(value, dxl::kMaxId);
      EepromItem item = Register(id, dxl::x::kId, to);
      item.new_id = to;
      return item;
    }
    if (setting == "baud") {
      const std::int32_t code = RateCode(kDynamixelRates, value);
      EepromItem item = Register(id, dxl::x::kBaudRate, static_cast<std::uint32_t>(code));
      item.new_baud = kDynamixelRates[static_cast<std::size_t>(code)];
      return item;
    }
    const auto which = SettingOfWord(setting);
    if (!which) RefuseSetting(setting);
    const auto number = SettingValue(*which, value);
    if (!number) RefuseValue(setting, value);
    if (*which == Setting::kProfileUnit) return DriveMode(id, *number == 1);
    Buffer buffer;
    const auto packet = bus::DynamixelBus::MakeSetting(id, *which, *number, buffer);
    if (!packet && packet.error() == Errc::kUnsupported) RefuseSetting(setting);
    if (!packet) RefuseValue(setting, value);
    return ItemOf(*packet);
  }

  void Write(std::uint8_t id, const EepromItem& item) override {
    const std::vector<std::byte>& packet = item.packets.front();
    if (item.new_id || item.new_baud) {
      line_.Send(packet);
      line_.Drain(kSettles);
      return;
    }
    const auto error = chain_.Ask(id, packet);
    if (!error) throw app::Failure("the servo does not acknowledge; is the line sound?");
    if (*error == dxl::StatusError::kNone) return;
    throw app::Failure(std::string("the servo refuses: ") + Name(*error) +
                       (*error == dxl::StatusError::kAccess
                            ? "; it has torque, which facewire servo reboot ends"
                            : ""));
  }

  void Close(std::uint8_t /*id*/) override {}  // torque closes it

  std::optional<std::vector<std::byte>> Read(std::uint8_t id, const EepromItem& item) override {
    const auto size = static_cast<std::uint16_t>(item.data.size());
    const auto value = chain_.Read(id, {item.address, size});
    if (!value) return std::nullopt;
    return BytesOf(*value, size);
  }

  void Reboot(std::uint8_t id) override {
    Buffer buffer;
    if (!chain_.Ask(id, *dxl::Reboot(id, buffer))) {
      throw app::Failure("the servo does not acknowledge; is the line sound?");
    }
  }

 private:
  static std::vector<std::byte> BytesOf(std::uint32_t value, std::size_t count) {
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i < count; ++i)
      bytes.push_back(static_cast<std::byte>(value >> 8U * i));
    return bytes;
  }
  static EepromItem Register(std::uint8_t id, dxl::Register what, std::uint32_t value) {
    Buffer buffer;
    return ItemOf(*dxl::Write(id, what.address, BytesOf(value, what.bytes), buffer));
  }
  // FF FF FD 00 id length (2) 03 address (2) data CRC (2); no setting is long enough to be stuffed.
  static EepromItem ItemOf(std::span<const std::byte> packet) {
    constexpr std::size_t kAddress = 8;
    const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(packet[i]); };
    return {.address = static_cast<std::uint16_t>(byte(kAddress) | byte(kAddress + 1) << 8U),
            .data = Kept(packet.subspan(kAddress + 2, packet.size() - kAddress - 4)),
            .packets = {Kept(packet)},
            .new_id = {},
            .new_baud = {}};
  }
  EepromItem DriveMode(std::uint8_t id, bool timed) {
    const auto now = chain_.Read(id, dxl::x::kDriveMode);
    if (!now) throw app::Failure("the servo does not answer");
    return Register(id, dxl::x::kDriveMode, timed ? *now | kTimeProfile : *now & ~kTimeProfile);
  }

  Line& line_;
  DynamixelLine chain_;
};

class FeetechChain final : public EepromChain {
 public:
  FeetechChain(Line& line, bus::FeetechSeries series)
      : line_(line), chain_(line), series_(series) {}

  bool Finds(std::uint8_t id) override { return chain_.Find(id).has_value(); }

  EepromItem Make(std::uint8_t id, std::string_view setting, std::string_view value) override {
    Buffer buffer;
    if (setting == "id") {
      const std::uint8_t to = IdOf(value, ft::kMaxId);
      EepromItem item = Register(id, ft::sts::kId.address, to);
      item.packets.insert(item.packets.begin(), Lock(id, false));
      item.new_id = to;
      return item;
    }
    if (setting == "lock") {
      const auto closed = SettingValue(Setting::kLock, value);
      if (!closed) RefuseValue(setting, value);
      return Register(id, LockAddress(), static_cast<std::uint8_t>(*closed));
    }
    const auto which = setting == "baud" ? Setting::kBaudRate : SettingOfWord(setting);
    if (!which) RefuseSetting(setting);
    const auto number =
        *which == Setting::kBaudRate ? RateCode(kFeetechRates, value) : SettingValue(*which, value);
    if (!number) RefuseValue(setting, value);
    const auto made = bus::FeetechBus::MakeSetting(series_, id, *which, *number, buffer);
    if (!made && made.error() == Errc::kUnsupported) RefuseSetting(setting);
    if (!made) RefuseValue(setting, value);
    EepromItem item = ItemOf(made->write);
    item.packets.insert(item.packets.begin(), Kept(made->unlock));
    if (*which == Setting::kBaudRate) {
      item.new_baud = kFeetechRates[static_cast<std::size_t>(*number)];
    }
    return item;
  }

  void Write(std::uint8_t id, const EepromItem& item) override {
    for (const std::vector<std::byte>& packet : item.packets) {
      const bool last = &packet == &item.packets.back();
      if (last && (item.new_id || item.new_baud)) {
        line_.Send(packet);
        line_.Drain(kSettles);
      } else if (!chain_.Ask(id, packet)) {
        throw app::Failure("the servo does not acknowledge; is the line sound?");
      }
    }
    closes_ = item.address != LockAddress();
  }

  void Close(std::uint8_t id) override {
    if (closes_ && !chain_.Ask(id, Lock(id, true))) {
      throw app::Failure("the servo does not acknowledge that its memory is closed; list it again");
    }
  }

  std::optional<std::vector<std::byte>> Read(std::uint8_t id, const EepromItem& item) override {
    return chain_.Bytes(
        id, {static_cast<std::uint8_t>(item.address), static_cast<std::uint8_t>(item.data.size())});
  }

  void Reboot(std::uint8_t id) override {
    // It does so only without torque.
    if (!chain_.Ask(id, Register(id, ft::sts::kTorqueEnable.address, 0).packets.front())) {
      throw app::Failure("the servo does not acknowledge; is the line sound?");
    }
    Buffer buffer;
    line_.Send(*ft::Reboot(id, buffer));
    line_.Drain(kSettles);
  }

 private:
  std::uint8_t LockAddress() const {
    return series_ == bus::FeetechSeries::kSts ? ft::sts::kLock.address : ft::scs::kLock.address;
  }
  std::vector<std::byte> Lock(std::uint8_t id, bool closed) const {
    return Register(id, LockAddress(), closed ? 1 : 0).packets.front();
  }
  static EepromItem Register(std::uint8_t id, std::uint8_t address, std::uint8_t value) {
    Buffer buffer;
    const std::byte data{value};
    return ItemOf(*ft::Write(id, address, std::span(&data, 1), buffer));
  }
  // FF FF id length 03 address data sum
  static EepromItem ItemOf(std::span<const std::byte> packet) {
    constexpr std::size_t kAddress = 5;
    return {.address = std::to_integer<std::uint16_t>(packet[kAddress]),
            .data = Kept(packet.subspan(kAddress + 1, packet.size() - kAddress - 2)),
            .packets = {Kept(packet)},
            .new_id = {},
            .new_baud = {}};
  }

  Line& line_;
  FeetechLine chain_;
  bus::FeetechSeries series_;
  bool closes_ = true;
};

}  // namespace

std::unique_ptr<EepromChain> MakeEepromChain(const app::ServoBusConfig& bus, Line& line) {
  switch (bus.kind) {
    case app::BusKind::kDynamixel:
      return std::make_unique<DynamixelChain>(line);
    case app::BusKind::kFeetech:
      return std::make_unique<FeetechChain>(line, bus.series);
    case app::BusKind::kMaestro:
    case app::BusKind::kReceiver:
      break;
  }
  return nullptr;
}

}  // namespace facewire::tools
