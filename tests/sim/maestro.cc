#include "tests/sim/maestro.h"

#include <algorithm>
#include <cmath>

namespace facewire::sim {
namespace {

// Commands, as their compact forms.
constexpr std::uint8_t kSetTarget = 0x84;
constexpr std::uint8_t kSetSpeed = 0x87;
constexpr std::uint8_t kSetAcceleration = 0x89;
constexpr std::uint8_t kSetPwm = 0x8A;
constexpr std::uint8_t kGetPosition = 0x90;
constexpr std::uint8_t kGetMovingState = 0x93;
constexpr std::uint8_t kSetMultipleTargets = 0x9F;
constexpr std::uint8_t kGetErrors = 0xA1;
constexpr std::uint8_t kGoHome = 0xA2;
constexpr std::uint8_t kStopScript = 0xA4;
constexpr std::uint8_t kRestartScript = 0xA7;
constexpr std::uint8_t kRestartScriptWith = 0xA8;
constexpr std::uint8_t kGetScriptStatus = 0xAE;
constexpr std::uint8_t kPololu = 0xAA;
constexpr std::uint8_t kMiniSsc = 0xFF;

constexpr int kUnknown = -1;
constexpr Nanos kAnswerDelay = 100'000;
// A servo that gets no pulse for two frames lets go.
constexpr unsigned kFrameMs = 20;
constexpr unsigned kStepMs = 10;

double SevenBitPair(std::uint8_t low, std::uint8_t high) { return low + 128.0 * high; }

}  // namespace

// Section 5.d works it out on paper as a long division, least significant bit first. This does the
// division the same way: bit by bit over the whole message.
std::uint8_t MaestroCrc(std::span<const std::uint8_t> packet) {
  constexpr unsigned kPolynomial = 0x91;  // 10001001 on paper, the first bit lowest
  unsigned remainder = 0;
  for (const std::uint8_t byte : packet) {
    remainder ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      if ((remainder & 1U) != 0) remainder ^= kPolynomial;
      remainder >>= 1U;
    }
  }
  return static_cast<std::uint8_t>(remainder);
}

Maestro::Maestro(const MaestroOptions& options)
    : Bus(options, options.model, 1500, 1 / kRadPerUs, /*half_duplex=*/false), options_(options) {
  channels_.resize(options.model);
  pulses_.resize(options.model);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (i < options.channels.size()) channels_[i].settings = options.channels[i];
    Home(channels_[i]);
  }
}

void Maestro::Home(Channel& channel) {
  if (channel.settings.home == MaestroHome::kIgnore) return;
  channel.target = 0;
  if (channel.settings.home == MaestroHome::kGoTo) channel.target = channel.settings.home_us * 4;
  // Where the pulses were off there is no position to start from; and off is off at once.
  if (channel.target == 0 || channel.pulse.position == 0) channel.pulse.Jump(channel.target);
}

void Maestro::GoHome() {
  for (Channel& channel : channels_) Home(channel);
}

void Maestro::Raise(Error error) {
  errors_ |= 1U << error;
  Happened(EventKind::kError, kWholeBus, static_cast<int>(errors_));
  GoHome();
}

// The serial mode decides which port the commands come from.
bool Maestro::HearsHost(std::uint8_t byte) {
  using Mode = MaestroOptions::SerialMode;
  const bool usb =
      options_.serial_mode == Mode::kUsbDualPort || options_.serial_mode == Mode::kUsbChained;
  if (options_.port == MaestroOptions::Port::kTtlPort) return false;  // goes to the board's TX pin
  if (usb) return options_.port == MaestroOptions::Port::kCommandPort;
  if (options_.port != MaestroOptions::Port::kRx) return false;
  if (options_.serial_mode == Mode::kUartDetectBaud && !baud_known_) {
    baud_known_ = byte == kPololu;
    return baud_known_;
  }
  return true;
}

void Maestro::OnByte(std::uint8_t byte, Nanos at) {
  if (!HearsHost(byte)) return;
  if (expect_ == Expect::kMiniAddress && byte != kMiniSsc) {
    mini_address_ = byte;
    expect_ = Expect::kMiniValue;
    return;
  }
  if (expect_ == Expect::kMiniValue && byte != kMiniSsc) {
    expect_ = Expect::kCommand;
    OnMiniSsc(mini_address_, byte);
    return;
  }
  if (byte < 0x80) {
    OnDataByte(byte, at);
    return;
  }
  // A packet that another one interrupts.
  if (expect_ != Expect::kCommand && expect_ != Expect::kNothing) {
    Happened(EventKind::kProtocol, kWholeBus, byte);
    Raise(kProtocolError);
  }
  raw_.assign(1, byte);
  data_.clear();
  command_ = byte;
  if (byte == kMiniSsc) {
    expect_ = Expect::kMiniAddress;
  } else if (byte == kPololu) {
    expect_ = Expect::kDevice;
  } else {
    expect_ = Expect::kData;
    OnPacket(at);
  }
}

void Maestro::OnDataByte(std::uint8_t byte, Nanos at) {
  switch (expect_) {
    case Expect::kNothing:
      return;  // the rest of another device's packet
    case Expect::kDevice:
      raw_.push_back(byte);
      expect_ = byte == options_.device_number ? Expect::kPololuCommand : Expect::kNothing;
      return;
    case Expect::kPololuCommand:
      raw_.push_back(byte);
      command_ = static_cast<std::uint8_t>(byte | 0x80U);
      expect_ = Expect::kData;
      OnPacket(at);
      return;
    case Expect::kData:
      raw_.push_back(byte);
      data_.push_back(byte);
      OnPacket(at);
      return;
    case Expect::kCrc:
      if (byte != MaestroCrc(raw_)) {
        expect_ = Expect::kCommand;
        Happened(EventKind::kDamagedPacket, kWholeBus, 0);
        Raise(kCrc);
        return;
      }
      OnPacket(at);
      return;
    default:
      Happened(EventKind::kProtocol, kWholeBus, byte);
      Raise(kProtocolError);
  }
}

// How many data bytes the command has; kUnknown for what this model does not know.
int Maestro::DataBytes() const {
  switch (command_) {
    case kSetTarget:
    case kSetSpeed:
    case kSetAcceleration:
    case kRestartScriptWith:
      return 3;
    case kSetPwm:
      return IsMini() ? 4 : kUnknown;
    case kSetMultipleTargets:
      if (!IsMini()) return kUnknown;
      return data_.empty() ? 1 : 2 + 2 * data_[0];
    case kGetPosition:
    case kRestartScript:
      return 1;
    case kGetMovingState:
    case kGetErrors:
    case kGoHome:
    case kStopScript:
    case kGetScriptStatus:
      return 0;
    default:
      return kUnknown;
  }
}

// Called whenever a packet may be complete; carries it out when it is.
void Maestro::OnPacket(Nanos at) {
  const int wanted = DataBytes();
  if (wanted == kUnknown) {
    expect_ = Expect::kNothing;
    Happened(EventKind::kProtocol, kWholeBus, command_);
    Raise(kProtocolError);
    return;
  }
  if (static_cast<int>(data_.size()) < wanted) return;
  if (options_.crc && expect_ == Expect::kData) {
    expect_ = Expect::kCrc;
    return;
  }
  expect_ = Expect::kCommand;
  const bool has_channel = command_ == kSetTarget || command_ == kSetSpeed ||
                           command_ == kSetAcceleration || command_ == kGetPosition;
  const bool outside =
      (has_channel && data_[0] >= channels_.size()) ||
      (command_ == kSetMultipleTargets && data_[0] + data_[1] > static_cast<int>(channels_.size()));
  if (outside) {
    Happened(EventKind::kProtocol, kWholeBus, command_);
    Raise(kProtocolError);
    return;
  }
  silence_ = Duration{};
  timed_out_ = false;
  switch (command_) {
    case kSetTarget:
      SetTarget(data_[0], SevenBitPair(data_[1], data_[2]));
      break;
    case kSetMultipleTargets:
      for (std::size_t i = 0; i < data_[0]; ++i) {
        SetTarget(data_[1] + i, SevenBitPair(data_[2 + 2 * i], data_[3 + 2 * i]));
      }
      break;
    case kSetSpeed:
      channels_[data_[0]].speed = static_cast<unsigned>(SevenBitPair(data_[1], data_[2]));
      break;
    case kSetAcceleration:
      channels_[data_[0]].acceleration =
          std::min(255U, static_cast<unsigned>(SevenBitPair(data_[1], data_[2])));
      break;
    case kGetPosition: {
      const auto position = static_cast<unsigned>(std::lround(channels_[data_[0]].pulse.position));
      Answer(
          {static_cast<std::uint8_t>(position & 0xFFU), static_cast<std::uint8_t>(position >> 8U)},
          at);
      break;
    }
    case kGetMovingState: {
      const bool moving = std::any_of(channels_.begin(), channels_.end(),
                                      [](const Channel& c) { return !c.pulse.At(c.target); });
      // The Micro Maestro's command has a fault: it may say 0 while servos move.
      Answer({static_cast<std::uint8_t>(moving && IsMini() ? 1 : 0)}, at);
      break;
    }
    case kGetErrors:
      Answer({static_cast<std::uint8_t>(errors_ & 0xFFU), static_cast<std::uint8_t>(errors_ >> 8U)},
             at);
      errors_ = 0;
      break;
    case kGoHome:
      GoHome();
      break;
    case kRestartScript:
    case kRestartScriptWith:
      Raise(kProgramCounter);  // the script from the works is empty
      break;
    case kGetScriptStatus:
      Answer({1}, at);  // stopped
      break;
    default:
      break;  // no PWM output, no script to stop
  }
}

void Maestro::OnMiniSsc(std::uint8_t address, std::uint8_t value) {
  if (address < options_.mini_ssc_offset) return;
  const std::size_t index = address - options_.mini_ssc_offset;
  if (index >= channels_.size()) return;  // of another controller on the line
  silence_ = Duration{};
  timed_out_ = false;
  const MaestroChannel& settings = channels_[index].settings;
  SetTarget(index,
            std::round(4 * (settings.neutral_us + settings.range_us * (value - 127) / 127.0)));
}

void Maestro::SetTarget(std::size_t index, double target) {
  Channel& channel = channels_[index];
  const double low = channel.settings.minimum_us * 4;
  const double high = channel.settings.maximum_us * 4;
  if (target != 0 && (target < low || target > high)) {
    Happened(EventKind::kOutsideLimits, static_cast<int>(index), static_cast<int>(target / 4));
    target = std::clamp(target, low, high);
  }
  channel.target = target;
  const bool unlimited = channel.speed == 0 && channel.acceleration == 0;
  if (target == 0 || channel.pulse.position == 0 || unlimited) channel.pulse.Jump(target);
}

void Maestro::Answer(std::initializer_list<std::uint8_t> bytes, Nanos at) {
  Reply(std::vector<std::uint8_t>(bytes), at, kAnswerDelay);
}

void Maestro::OnMillisecond(Time) {
  ++millisecond_;
  silence_ += Duration(1000);
  if (options_.serial_timeout > Duration{} && !timed_out_ && silence_ >= options_.serial_timeout) {
    timed_out_ = true;
    Happened(EventKind::kWatchdog, kWholeBus,
             static_cast<int>(options_.serial_timeout / Duration(1000)));
    Raise(kTimeout);
  }
  if (millisecond_ % kStepMs == 0) {
    for (Channel& channel : channels_) {
      if (channel.target == 0 || channel.pulse.position == 0) continue;
      channel.pulse.Step(channel.target, channel.speed, channel.acceleration / 8.0);
    }
  }
  if (millisecond_ % kFrameMs != 0) return;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const double width = std::round(channels_[i].pulse.position);
    // A missing pulse is noticed a frame later.
    if (width == 0 && pulses_[i] == 0) servo(i).Release();
    pulses_[i] = width;
    if (width != 0 && Running(i)) servo(i).GoTo(ToRad(width / 4));
  }
}

}  // namespace facewire::sim
