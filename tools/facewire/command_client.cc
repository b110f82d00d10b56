#include "tools/facewire/command_client.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <span>
#include <utility>
#include <variant>

#include "app/error.h"

namespace facewire::tools {
namespace {

using std::chrono::milliseconds;

// As core/wire/README.md asks of a host.
constexpr milliseconds kPingEvery(500);

std::string InSeconds(Duration time) {
  std::array<char, 32> text;
  (void)std::snprintf(text.data(), text.size(), "%g s", static_cast<double>(Seconds(time)));
  return text.data();
}

}  // namespace

// Ids begin anywhere: an answer to a client before this one may still be on the line.
CommandClient::CommandClient(std::string name, hal::SerialPort& port, hal::Clock& clock)
    : name_(std::move(name)),
      port_(port),
      clock_(clock),
      last_id_(static_cast<std::uint16_t>(clock.Now().time_since_epoch().count())) {}

wire::Acknowledgement CommandClient::Ask(wire::Command command, Duration timeout) {
  const Time until = clock_.Now() + timeout;
  const wire::Command ping{.id = ++last_id_, .code = wire::CommandCode::kPing};
  bool heard = false;
  while (!heard) {
    if (clock_.Now() >= until) {
      throw app::Failure(name_ + ": nothing answers within " + InSeconds(timeout) +
                         "; is it a facewire device, and running?");
    }
    Send(ping);
    heard = Await(ping.id, std::min<Time>(clock_.Now() + kPingEvery, until)).has_value();
  }
  command.id = ++last_id_;
  text_.clear();
  Send(command);
  const auto answer = Await(command.id, until);
  if (answer) return *answer;
  throw app::Failure(name_ + ": no answer to " + Name(command.code) + " within " +
                     InSeconds(timeout) + "; give it longer with --timeout");
}

std::optional<wire::Acknowledgement> CommandClient::Say(wire::Command command, Duration longest) {
  command.id = ++last_id_;
  text_.clear();
  Send(command);
  return Await(command.id, clock_.Now() + longest);
}

void CommandClient::Send(const wire::Command& command) {
  std::array<std::byte, wire::kCommandFrameBytes> buffer;
  const auto frame = encoder_.Encode(command, buffer);
  if (!frame) throw app::Failure(name_ + ": the command cannot be sent: " + Name(frame.error()));
  // A line that takes nothing for a moment does not answer in time, and the caller tells.
  const auto written = port_.Write(*frame, kPingEvery);
  if (written || written.error() == Errc::kTimeout) return;
  throw app::Failure(name_ + ": the other side has closed the line");
}

std::optional<wire::Acknowledgement> CommandClient::Await(std::uint16_t id, Time until) {
  std::array<std::byte, 4096> buffer;
  std::optional<wire::Acknowledgement> answer;
  while (!answer && clock_.Now() < until) {
    const auto left = std::chrono::ceil<milliseconds>(until - clock_.Now());
    const auto read = port_.Read(buffer, std::max(left, milliseconds(0)));
    if (!read) {
      if (read.error() == Errc::kTimeout) continue;
      throw app::Failure(name_ + ": the other side has closed the line");
    }
    std::span<const std::byte> rest = std::span(buffer).first(*read);
    while (!rest.empty()) {
      const auto received = decoder_.Next(rest);
      if (!received) continue;
      const auto* heard = std::get_if<wire::Acknowledgement>(&received->message);
      if (heard != nullptr && heard->id == id) answer = *heard;
      const auto* words = std::get_if<wire::Text>(&received->message);
      if (words != nullptr && words->id == id) text_.append(words->text.begin(), words->text.end());
    }
  }
  return answer;
}

}  // namespace facewire::tools
