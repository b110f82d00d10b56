#ifndef FACEWIRE_TESTS_SIM_MAESTRO_H_
#define FACEWIRE_TESTS_SIM_MAESTRO_H_

#include <cstdint>
#include <span>
#include <vector>

#include "tests/sim/approach.h"
#include "tests/sim/bus.h"

namespace facewire::sim {

// How a channel starts and what it does when anything goes wrong.
enum class MaestroHome : std::uint8_t { kOff, kIgnore, kGoTo };

// A Maestro's permanent settings, as its maker's program would set them; all pulses in us.
struct MaestroChannel {
  double minimum_us = 992;
  double maximum_us = 2000;
  MaestroHome home = MaestroHome::kOff;
  double home_us = 1500;
  double neutral_us = 1500;  // of Mini-SSC commands
  double range_us = 476.25;
};

struct MaestroOptions : BusOptions {
  // kCommandPort and kTtlPort are the two ports of its USB side; kRx is the board's own pin.
  enum class Port : std::uint8_t { kCommandPort, kTtlPort, kRx };
  enum class SerialMode : std::uint8_t { kUsbDualPort, kUsbChained, kUartDetectBaud, kUartFixed };

  MaestroOptions() { baud = 10'000'000; }  // USB: the host's rate does not matter

  std::size_t model = 6;  // 6, 12, 18 or 24 channels, a servo on each
  Port port = Port::kCommandPort;
  SerialMode serial_mode = SerialMode::kUsbDualPort;  // the works set kUartDetectBaud
  std::uint8_t device_number = 12;
  std::uint8_t mini_ssc_offset = 0;
  bool crc = false;
  Duration serial_timeout{};             // zero: off; the device keeps steps of 10 ms
  std::vector<MaestroChannel> channels;  // those beyond the end as from the works
};

// The byte that ends a packet in CRC mode.
std::uint8_t MaestroCrc(std::span<const std::uint8_t> packet);

// Pololu's Micro (6) and Mini (12, 18, 24) Maestro with hobby servos; position in us of pulse
// width, 0 while the pulses are off. Its servos protect themselves from nothing.
class Maestro final : public Bus {
 public:
  // Bits of the error register.
  enum Error : unsigned {
    kSignal,
    kOverrun,
    kBufferFull,
    kCrc,
    kProtocolError,
    kTimeout,
    kScriptStack,
    kCallStack,
    kProgramCounter
  };
  static constexpr double kRadPerUs = 90 * kDegree / 1000;  // a servo's 180 degrees are 2000 us

  explicit Maestro(const MaestroOptions& options);

  double Goal(std::size_t index) const override { return channels_[index].target / 4; }
  double Commanded(std::size_t index) const override { return pulses_[index] / 4; }
  double ToOwn(double rad) const override { return 1500 + rad / kRadPerUs; }
  double ToRad(double own) const override { return (own - 1500) * kRadPerUs; }

  unsigned errors() const { return errors_; }  // as Get Errors would answer, without clearing
  // The line's own errors, which the bytes alone do not show: kSignal, kOverrun, kBufferFull.
  void Raise(Error error);

 private:
  struct Channel {
    MaestroChannel settings;
    double target = 0;  // everything in quarters of a microsecond; 0: off
    Approach pulse;
    unsigned speed = 0, acceleration = 0;
  };

  void OnByte(std::uint8_t byte, Nanos at) override;
  void OnMillisecond(Time at) override;
  void OnPowerUp(std::size_t) override {}  // a hobby servo remembers nothing

  bool HearsHost(std::uint8_t byte);
  void OnDataByte(std::uint8_t byte, Nanos at);
  int DataBytes() const;
  void OnPacket(Nanos at);
  void OnMiniSsc(std::uint8_t address, std::uint8_t value);
  void SetTarget(std::size_t channel, double target);
  void GoHome();
  void Home(Channel& channel);
  void Answer(std::initializer_list<std::uint8_t> bytes, Nanos at);
  bool IsMini() const { return channels_.size() > 6; }

  MaestroOptions options_;
  std::vector<Channel> channels_;
  std::vector<double> pulses_;  // the last that each servo got, in 0.25 us
  unsigned errors_ = 0;
  bool baud_known_ = false;
  Duration silence_{};
  bool timed_out_ = false;
  unsigned millisecond_ = 0;

  // The packet that is being received.
  enum class Expect : std::uint8_t {
    kCommand,
    kDevice,
    kPololuCommand,
    kData,
    kCrc,
    kMiniAddress,
    kMiniValue,
    kNothing
  };
  Expect expect_ = Expect::kCommand;
  std::uint8_t command_ = 0;
  std::vector<std::uint8_t> data_;
  std::vector<std::uint8_t> raw_;  // everything that the CRC covers
  std::uint8_t mini_address_ = 0;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_MAESTRO_H_
