#include "core/wire/osc_host/command.h"

#include <cmath>
#include <optional>
#include <string_view>

namespace facewire::wire::osc_host {
namespace {

struct Verb {
  std::string_view address;
  CommandCode code;
};
// But for the stop.
constexpr std::array kVerbs = {
    Verb{"/facewire/ping", CommandCode::kPing},
    Verb{"/facewire/describe", CommandCode::kDescribeRig},
    Verb{"/facewire/calibrate", CommandCode::kCalibrateNeutral},
    Verb{"/facewire/neutral", CommandCode::kRest},
    Verb{"/facewire/release", CommandCode::kRelease},
    Verb{"/facewire/blend", CommandCode::kBlendProfile},
};

// A packet that has the stop's address anywhere, alone or in a bundle, whole or not. Stopping once
// too often costs little.
bool SaysStop(std::span<const std::byte> packet) noexcept {
  constexpr std::string_view kStop("/facewire/stop");
  const std::string_view text(reinterpret_cast<const char*>(packet.data()), packet.size());
  const std::size_t at = text.find(kStop);
  return at != std::string_view::npos &&
         (at + kStop.size() == text.size() || text[at + kStop.size()] == '\0');
}

// A button on a screen sends 1 when it is pressed, and 0 when it is let go: that is no command.
Result<Command> CommandOf(const osc::MessageView& message) noexcept {
  for (const Verb& verb : kVerbs) {
    if (message.address != verb.address) continue;
    Command command{.code = verb.code};
    const std::optional<float> number = message.Number();
    if (message.types.size() > (number ? 1U : 0U)) return Errc::kInvalidArgument;
    if (TakesValue(verb.code)) {
      if (!number || !std::isfinite(*number)) return Errc::kInvalidArgument;
      command.value = *number;
    } else if (number && *number != 1.0F) {
      return Errc::kInvalidArgument;
    }
    return command;
  }
  return Errc::kUnsupported;
}

}  // namespace

Result<Command> CommandDecoder::Next(std::span<const std::byte>& bytes) noexcept {
  if (const auto message = reader_.Next()) return Count(CommandOf(*message));
  const auto packet = slip_.Next(bytes);
  if (!packet) return packet.error() == Errc::kNotReady ? Errc::kNotReady : Count(packet.error());
  if (SaysStop(*packet)) return Count(Command{.code = CommandCode::kStop});
  const auto reader = osc::Reader::Of(*packet);
  if (!reader) return Count(Errc::kCorrupt);
  reader_ = *reader;
  const auto message = reader_.Next();
  return message ? Count(CommandOf(*message)) : Errc::kNotReady;
}

Result<Command> CommandDecoder::Count(Result<Command> command) noexcept {
  if (command) {
    ++stats_.frames;
  } else if (command.error() == Errc::kUnsupported) {
    ++stats_.unknown;
  } else if (command.error() == Errc::kInvalidArgument) {
    ++stats_.malformed;
  } else if (command.error() == Errc::kFull) {
    ++stats_.overflows;
  } else {
    ++stats_.truncated;
  }
  return command;
}

}  // namespace facewire::wire::osc_host
