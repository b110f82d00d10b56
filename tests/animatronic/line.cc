#include "tests/animatronic/line.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/animatronic/animatronic.h"
#include "tests/sim/dynamixel.h"
#include "tests/sim/feetech.h"
#include "tests/sim/maestro.h"
#include "tests/tools/firmware/firmware_bus.h"

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;

constexpr double kRange = 90;           // degrees
constexpr double kSpeed = 270;          // degrees a second
constexpr double kAcceleration = 5400;  // degrees a second and second
constexpr double kCrawl = 18;           // degrees a second
constexpr double kDeadBand = 0.45;      // degrees
constexpr std::uint32_t kBaud = 1'000'000;
constexpr std::uint32_t kReceiverBaud = 115'200;

// A hobby servo lets go two frames after its last pulse.
constexpr Duration kPulseFrames = milliseconds(60);
// A receiver plans the pulses of the next 20 ms.
constexpr Duration kReceiverFrames = milliseconds(80);
// BusConfig::reply_timeout, up to the next tick.
constexpr Duration kWaits = milliseconds(30);
// A chain's bytes of one tick, in time.
constexpr Duration kBytesTime = milliseconds(3);

}  // namespace

const char* Name(Kind kind) {
  constexpr std::array<const char*, kKinds.size()> kNames = {"maestro", "receiver", "dynamixel",
                                                             "sts", "scs"};
  return kNames[static_cast<std::size_t>(kind)];
}

double DegreesPerUnit(Kind kind) {
  if (IsPulses(kind)) return 0.09;
  return kind == Kind::kScs ? 300.0 / 1024 : 360.0 / 4096;
}

servo::Servo ServoOf(Kind kind, std::size_t number, std::uint8_t id) {
  const double unit = 1 / DegreesPerUnit(kind);
  const double neutral = IsPulses(kind) ? 1500 : kind == Kind::kScs ? 512 : 2048;
  const auto in_units = [&](double degrees) { return static_cast<float>(degrees * unit); };
  servo::Servo servo;
  servo.name = *ShortName::From(std::string(Name(kind)) + "_" + std::to_string(number));
  servo.bus = *ShortName::From(Name(kind));
  servo.id = id;
  servo.neutral = static_cast<float>(neutral);
  servo.min = servo.neutral - in_units(kRange / 2);
  servo.max = servo.neutral + in_units(kRange / 2);
  (void)servo.sources.try_push({*ShortName::From("p" + std::to_string(number)), 1});
  (void)servo.map.try_push({0, servo.min});
  (void)servo.map.try_push({1, servo.max});
  servo.dead_band = in_units(kDeadBand);
  servo.max_speed_per_s = in_units(kSpeed);
  servo.max_acceleration_per_s2 = in_units(kAcceleration);
  servo.crawl_speed_per_s = in_units(kCrawl);
  return servo;
}

Line::Line(const LineOptions& options, const servo::Contract& contract,
           std::span<const servo::Servo> servos)
    : options_(options), contract_(contract), servos_(servos.begin(), servos.end()) {
  switch (options.kind) {
    case Kind::kMaestro:
      BuildMaestro();
      break;
    case Kind::kReceiver:
      BuildReceiver();
      break;
    case Kind::kDynamixel:
      BuildDynamixel();
      break;
    case Kind::kSts:
    case Kind::kScs:
      BuildFeetech();
      break;
  }
  StartDriver();
}

void Line::StartDriver() {
  bus::BusConfig config;
  config.baud = options_.kind == Kind::kReceiver ? kReceiverBaud : kBaud;
  for (const servo::Servo& servo : servos_) {
    (void)config.servos.try_push(animatronic::ConfigOf(servo, {}));
  }
  const auto start = [&](auto& driver, const auto& all) {
    if (!driver.Configure(all)) throw std::logic_error("this bus is no bus");
    driver_ = &driver;
  };
  switch (options_.kind) {
    case Kind::kMaestro:
      start(drivers_.emplace<bus::MaestroBus>(),
            bus::MaestroConfig{.bus = config,
                               .line = {.pololu = false, .device = 12, .crc = options_.crc},
                               .multi_target = options_.multi_target,
                               .answers = true});
      break;
    case Kind::kReceiver:
      start(drivers_.emplace<bus::ReceiverBus>(), bus::ReceiverConfig{.bus = config,
                                                                      .hold = contract_.hold,
                                                                      .ease = contract_.ease,
                                                                      .release = contract_.limp});
      break;
    case Kind::kDynamixel:
      start(drivers_.emplace<bus::DynamixelBus>(), bus::DynamixelConfig{.bus = config});
      break;
    case Kind::kSts:
      start(drivers_.emplace<bus::FeetechBus>(), bus::FeetechConfig{.bus = config});
      break;
    case Kind::kScs:
      start(drivers_.emplace<bus::FeetechBus>(),
            bus::FeetechConfig{.bus = config, .series = bus::FeetechSeries::kScs});
      break;
  }
}

void Line::BuildMaestro() {
  sim::MaestroOptions board;
  board.model = options_.multi_target ? 12 : 6;
  board.crc = options_.crc;
  board.serial_timeout = options_.serial_timeout;
  board.poses = options_.poses;
  board.faults.line = options_.faults;
  board.seed = options_.seed;
  board.supply_ohm = 0.02;
  for (const servo::Servo& servo : servos_) {
    sim::MaestroChannel channel;
    channel.minimum_us = servo.min;
    channel.maximum_us = servo.max;
    channel.home = options_.home_neutral ? sim::MaestroHome::kGoTo : sim::MaestroHome::kOff;
    channel.home_us = servo.neutral;
    board.channels.push_back(channel);
  }
  bus_ = std::make_unique<sim::Maestro>(board);
}

void Line::BuildReceiver() {
  firmware::FirmwareBusOptions board;
  board.baud = kReceiverBaud;
  board.poses = options_.poses;
  board.faults.line = options_.faults;
  board.seed = options_.seed;
  board.supply_ohm = 0.02;
  bus_ = std::make_unique<firmware::FirmwareBus>(board);
}

void Line::BuildDynamixel() {
  sim::DynamixelOptions chain;
  chain.ids.clear();
  for (const servo::Servo& servo : servos_) chain.ids.push_back(servo.id);
  chain.baud = kBaud;
  chain.poses = options_.poses;
  chain.faults.line = options_.faults;
  chain.seed = options_.seed;
  auto bus = std::make_unique<sim::Dynamixel>(chain);
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    bus->SetEntry(i, sim::dynamixel::kMinPosition,
                  static_cast<std::int32_t>(std::ceil(servos_[i].min)));
    bus->SetEntry(i, sim::dynamixel::kMaxPosition,
                  static_cast<std::int32_t>(std::floor(servos_[i].max)));
  }
  bus_ = std::move(bus);
}

void Line::BuildFeetech() {
  const bool sts = options_.kind == Kind::kSts;
  const sim::FeetechSeries& series = sts ? sim::Sts() : sim::Scs();
  sim::FeetechOptions chain(series);
  chain.ids.clear();
  for (const servo::Servo& servo : servos_) chain.ids.push_back(servo.id);
  chain.baud = kBaud;
  chain.poses = options_.poses;
  chain.faults.line = options_.faults;
  chain.seed = options_.seed;
  auto bus = std::make_unique<sim::Feetech>(chain);
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    sim::FeetechServo& memory = bus->memory(i);
    const auto write = [&](std::uint8_t address, float value) {
      const auto counts = static_cast<unsigned>(value);
      const auto low = static_cast<std::uint8_t>(counts & 0xFFU);
      const auto high = static_cast<std::uint8_t>(counts >> 8U);
      memory.Write(address, std::array{sts ? low : high, sts ? high : low});
    };
    memory.Write(series.lock, std::array<std::uint8_t, 1>{0});
    write(sim::feetech::kMinAngle, std::ceil(servos_[i].min));
    write(sim::feetech::kMaxAngle, std::floor(servos_[i].max));
    memory.Write(series.lock, std::array<std::uint8_t, 1>{1});
  }
  bus_ = std::move(bus);
}

Seen Line::Look(std::size_t servo) const {
  return {.torque = bus_->TorqueOn(servo),
          .told = !IsPulses(options_.kind) || bus_->Goal(servo) != 0,
          .goal = bus_->Goal(servo),
          .commanded = bus_->Commanded(servo),
          .position = bus_->Position(servo),
          .sensed = bus_->ToOwn(bus_->servo(servo).sensed_rad())};
}

Wire Line::wire(std::size_t servo) const {
  const bus::ServoConfig limits = animatronic::ConfigOf(servos_[servo], {});
  const bool pulses = IsPulses(options_.kind);
  const bool receiver = options_.kind == Kind::kReceiver;
  return {
      .step = driver_->traits().step,
      .reaction = options_.period + kBytesTime,
      .lets_go = receiver ? kReceiverFrames
                 : pulses ? kPulseFrames
                          : Duration{},
      .held_back = pulses ? Duration{} : kWaits,
      .weak_sum = options_.kind == Kind::kSts || options_.kind == Kind::kScs ||
                  (options_.kind == Kind::kMaestro && !options_.crc),
      .home = options_.home_neutral ? std::optional<double>(servos_[servo].neutral) : std::nullopt,
      // A Dynamixel's speeds are whole steps of 15.6 counts a second.
      .own_speed = pulses ? 0.0 : limits.top_speed_per_s + 16.0};
}

void Line::ToServos(std::span<const std::byte> bytes, Time world) {
  if (left_) {
    const std::size_t passes = std::min(*left_, bytes.size());
    bytes = bytes.first(passes);
    *left_ -= passes;
  }
  if (!deaf && !bytes.empty()) bus_->Receive(bytes, world);
  if (left_ && *left_ == 0) deaf = silent = true;
}

std::vector<std::byte> Line::ToHost() {
  std::vector<std::byte> bytes = bus_->Transmit();
  if (silent) bytes.clear();
  if (damage) damage(bytes);
  return bytes;
}

}  // namespace facewire::stage
