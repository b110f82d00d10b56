#include "tools/facewire/servo/probe.h"

#include <array>
#include <chrono>
#include <variant>

#include "core/wire/decoder.h"
#include "core/wire/feetech/packet.h"
#include "core/wire/maestro/maestro.h"
#include "core/wire/servo_message.h"
#include "tools/facewire/servo/dynamixel_line.h"
#include "tools/facewire/servo/feetech_line.h"

namespace facewire::tools {
namespace {

namespace ft = wire::feetech;
namespace x = wire::dynamixel::x;
using std::chrono::milliseconds;
using wire::maestro::Reply;

// Of a boot loader that waits for a new program, and the second between two reports.
constexpr milliseconds kReceiverSpeaks(2500);
// USB adapters hold bytes back for up to 16 ms; a Maestro at 9600 baud takes 2 ms to answer.
constexpr milliseconds kMaestroReply(30);
constexpr milliseconds kQuiet(30);
constexpr std::uint8_t kFirstIds = 20;

// Asks by one framing, first without a CRC, then completes the packet with one.
class MaestroQuestion {
 public:
  MaestroQuestion(Line& line, bool pololu) : line_(line), settings_{.pololu = pololu} {}

  // Whether a board answers that has been asked for its errors.
  bool Knock() {
    Buffer buffer;
    const auto packet = *wire::maestro::Encoder(settings_).GetErrors(buffer);
    line_.Send(packet);
    if (Errors()) return true;
    const std::byte crc{wire::maestro::Crc7(packet)};
    line_.Send(std::span(&crc, 1));
    settings_.crc = true;
    return Errors().has_value();
  }
  // Bare bytes say little: a Maestro answers with two, with one, and with two zeros, because
  // reading the errors has cleared them.
  bool Confirm() {
    Buffer buffer;
    const wire::maestro::Encoder encoder(settings_);
    line_.Send(*encoder.GetMovingState(buffer));
    if (!Answer(Reply::kMovingState)) return false;
    line_.Send(*encoder.GetErrors(buffer));
    const auto errors = Errors();
    return errors && *errors == 0;
  }
  bool crc() const { return settings_.crc; }

 private:
  using Buffer = std::array<std::byte, wire::maestro::kMaxPacketBytes>;

  std::optional<std::uint16_t> Errors() { return Answer(Reply::kErrors); }
  // Exactly the bytes of such a reply, and then silence.
  std::optional<std::uint16_t> Answer(Reply reply) {
    std::optional<std::uint16_t> value;
    bool wrong = false;
    wire::maestro::ReplyReader reader;
    reader.Expect(reply);
    line_.Receive(kMaestroReply, [&](std::span<const std::byte> bytes) {
      const auto got = reader.Next(bytes);
      if (got) value = *got;
      wrong =
          wrong || (!got && got.error() != Errc::kNotReady) || !bytes.empty() || reader.stray() > 0;
      return wrong;
    });
    if (wrong) line_.Drain(kQuiet);
    return wrong ? std::nullopt : value;
  }

  Line& line_;
  wire::maestro::Line settings_;
};

FoundServo AskDynamixel(DynamixelLine& chain, const DynamixelLine::Servo& at) {
  FoundServo servo{.id = at.id, .model = DynamixelModel(at.model)};
  if (const auto position = chain.Read(at.id, x::kPresentPosition))
    servo.position = static_cast<int>(*position);
  if (const auto heat = chain.Read(at.id, x::kPresentTemperature))
    servo.temperature_c = static_cast<float>(*heat);
  if (const auto voltage = chain.Read(at.id, x::kPresentVoltage))
    servo.voltage_v = static_cast<float>(*voltage) / 10;
  return servo;
}

FoundServo AskFeetech(FeetechLine& chain, std::uint8_t id, const FeetechLine::Servo& at) {
  const bool scs = at.series == bus::FeetechSeries::kScs;
  FoundServo servo{.id = id, .model = FeetechModel(at.model, scs)};
  if (const auto position = chain.Read(id, ft::sts::kPresentPosition, at.series))
    servo.position = ft::FromSignMagnitude(*position, ft::kPositionSign);
  if (const auto heat = chain.Read(id, ft::sts::kPresentTemperature, at.series))
    servo.temperature_c = static_cast<float>(*heat);
  if (const auto voltage = chain.Read(id, ft::sts::kPresentVoltage, at.series))
    servo.voltage_v = static_cast<float>(*voltage) / 10;
  return servo;
}

}  // namespace

std::optional<FoundBus> ProbeReceiver(Line& line) {
  std::optional<FoundBus> found;
  wire::Decoder decoder;
  line.Receive(kReceiverSpeaks, [&](std::span<const std::byte> bytes) {
    for (;;) {
      const auto received = decoder.Next(bytes);
      if (!received && received.error() == Errc::kNotReady) return found.has_value();
      if (!received) continue;
      const auto* status = std::get_if<wire::ReceiverStatus>(&received->message);
      if (status == nullptr) continue;
      found.emplace();
      found->protocol = Protocol::kReceiver;
      found->about = "firmware " + std::to_string(status->version_major) + "." +
                     std::to_string(status->version_minor) + ", " +
                     std::to_string(status->capacity) + " servos";
    }
  });
  return found;
}

std::optional<FoundBus> ProbeMaestro(Line& line) {
  line.Drain(kQuiet);
  // First the framing that begins with AA: it also tells a board that detects the rate which one
  // it is.
  for (const bool pololu : {true, false}) {
    MaestroQuestion question(line, pololu);
    if (!question.Knock() || !question.Confirm()) continue;
    return FoundBus{.protocol = Protocol::kMaestro,
                    .port = {},
                    .baud = 0,
                    .about = std::string(pololu ? "device number 12" : "another device number") +
                             (question.crc() ? ", CRC mode" : "") +
                             "; how many channels it has cannot be asked",
                    .servos = {},
                    .crc = question.crc()};
  }
  return std::nullopt;
}

std::optional<FoundBus> ProbeDynamixel(Line& line) {
  DynamixelLine chain(line);
  FoundBus bus{.protocol = Protocol::kDynamixel};
  for (const DynamixelLine::Servo& servo : chain.PingAll())
    bus.servos.push_back(AskDynamixel(chain, servo));
  if (bus.servos.empty()) return std::nullopt;
  return bus;
}

std::optional<FoundBus> ProbeFeetech(Line& line, bool all_ids) {
  FeetechLine chain(line);
  FoundBus bus{.protocol = Protocol::kFeetech};
  for (std::uint8_t id = 0; id <= (all_ids ? ft::kMaxId : kFirstIds); ++id) {
    const auto servo = chain.Find(id);
    if (!servo) continue;
    bus.scs = servo->series == bus::FeetechSeries::kScs;
    bus.servos.push_back(AskFeetech(chain, id, *servo));
  }
  if (bus.servos.empty()) return std::nullopt;
  return bus;
}

std::span<const int> UsualRates(Protocol protocol) {
  static constexpr std::array kFirmware = {115'200};
  static constexpr std::array kMaestro = {115'200, 9600};  // on USB any; on wires as delivered
  static constexpr std::array kDynamixel = {57'600,    1'000'000, 115'200,
                                            2'000'000, 3'000'000, 4'000'000};
  static constexpr std::array kFeetech = {1'000'000, 500'000, 115'200, 250'000, 57'600, 38'400};
  switch (protocol) {
    case Protocol::kReceiver:
      return kFirmware;
    case Protocol::kMaestro:
      return kMaestro;
    case Protocol::kDynamixel:
      return kDynamixel;
    case Protocol::kFeetech:
      return kFeetech;
  }
  return {};
}

}  // namespace facewire::tools
