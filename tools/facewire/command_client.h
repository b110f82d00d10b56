#ifndef FACEWIRE_TOOLS_FACEWIRE_COMMAND_CLIENT_H_
#define FACEWIRE_TOOLS_FACEWIRE_COMMAND_CLIENT_H_

#include <cstdint>
#include <optional>
#include <string>

#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "hal/clock.h"
#include "hal/serial_port.h"

namespace facewire::tools {

// Gives commands to a running service over any line that speaks the native protocol: its control
// socket, or the serial line to a device, where poses come in between.
class CommandClient {
 public:
  // `port` is open; everything is borrowed. `name` is for messages.
  CommandClient(std::string name, hal::SerialPort& port, hal::Clock& clock);

  // The answer to `command`, whose id is chosen here. First pings, again and again, until the other
  // side answers; then sends the command once: a line that just passed a ping passes it, and a
  // command that was heard twice might be done twice. Throws Failure when nothing answers within
  // `timeout`, or the line is lost.
  wire::Acknowledgement Ask(wire::Command command, Duration timeout);
  // Says it once, and waits for its answer for `longest` at most: for what is repeated anyway.
  // Throws Failure when the line is lost.
  std::optional<wire::Acknowledgement> Say(wire::Command command, Duration longest);
  // What the last answer said in words besides; usually nothing.
  const std::string& text() const { return text_; }

 private:
  void Send(const wire::Command& command);
  // The answer to the command with this id, if it comes until then.
  std::optional<wire::Acknowledgement> Await(std::uint16_t id, Time until);

  std::string name_;
  hal::SerialPort& port_;
  hal::Clock& clock_;
  wire::Encoder encoder_;
  wire::Decoder decoder_;
  std::uint16_t last_id_;
  std::string text_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_COMMAND_CLIENT_H_
