// Commands to a running service.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/answer_text.h"
#include "app/devices.h"
#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/command_client.h"
#include "tools/facewire/commands.h"

namespace facewire::tools {
namespace {

struct ControlOptions {
  std::string where = "/run/facewire/control";
  int baud = 115200;
  double timeout_s = 5;
  double percent = 0;
};

// One wherever the service is: its socket on this machine, or a device at the end of a line.
std::unique_ptr<hal::SerialPort> OpenService(const ControlOptions& options) {
  auto port = app::MakeSerialPort(options.where, options.baud);
  const Result<> opened = port->Open();
  if (opened) return port;
  if (opened.error() == Errc::kNotFound) {
    throw app::BadInput("no service is at " + options.where +
                        "; start facewired, or give its control socket, or the port of a device");
  }
  if (opened.error() == Errc::kPermission) {
    throw app::BadInput("no permission for " + options.where +
                        "; its group may use it: sudo usermod -aG GROUP $USER, with the group "
                        "that `ls -l` shows");
  }
  throw app::BadInput(app::DescribeSerialError(opened.error(), options.where, options.baud));
}

void Give(const wire::Command& command, const ControlOptions& options) {
  const auto port = OpenService(options);
  hal::SystemClock clock;
  CommandClient client(options.where, *port, clock);
  const wire::Acknowledgement answer =
      client.Ask(command, Duration(static_cast<std::int64_t>(1e6 * options.timeout_s)));
  const std::string text = app::AnswerText(answer).data();
  if (answer.result != wire::CommandResult::kOk) throw app::Failure(text);
  std::printf("%s\n", text.c_str());
}

// What every one of these commands has.
void AddControlOptions(CLI::App& command, ControlOptions& options) {
  command
      .add_option("WHERE", options.where,
                  "The service's control socket, or the serial port of a device")
      ->capture_default_str();
  command.add_option("--baud", options.baud, "Bits a second of a serial port")
      ->capture_default_str()
      ->check(CLI::Range(300, 4'000'000));
  command.add_option("--timeout", options.timeout_s, "Seconds to wait for the answer")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 3600.0));
  command.footer("Exit codes: 0 done, 1 refused or failed (stderr says why), 2 bad usage.");
}

}  // namespace

void AddCalibrate(CLI::App& facewire) {
  auto options = std::make_shared<ControlOptions>();
  options->timeout_s = 15;  // the service tries for ten
  CLI::App* command = facewire.add_subcommand(
      "calibrate", "Have the running service take the performer's face at rest");
  AddControlOptions(*command, *options);
  command->footer(
      "Look at the camera and hold still: the first still second within ten is taken.\n" +
      command->get_footer());
  command->callback([options] { Give({.code = wire::CommandCode::kCalibrateNeutral}, *options); });
}

void AddBlend(CLI::App& facewire) {
  auto options = std::make_shared<ControlOptions>();
  CLI::App* command = facewire.add_subcommand(
      "blend", "Set how much of the personal profile the running service uses");
  command
      ->add_option("PERCENT", options->percent,
                   "0: the default profile alone; 100: the personal one")
      ->required()
      ->check(CLI::Range(0.0, 100.0));
  AddControlOptions(*command, *options);
  command->callback([options] {
    Give({.code = wire::CommandCode::kBlendProfile,
          .value = static_cast<float>(options->percent / 100)},
         *options);
  });
}

}  // namespace facewire::tools
