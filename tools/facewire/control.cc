// Commands to a running service.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/answer_text.h"
#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/command_client.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/open_service.h"
#include "tools/facewire/report_text.h"

namespace facewire::tools {
namespace {

struct ControlOptions {
  std::string where = "/run/facewire/control";
  int baud = 115200;
  double timeout_s = 5;
  double percent = 0;
  bool json = false;
};

struct Answered {
  wire::Acknowledgement answer;
  std::string text;  // what the service says besides, lines
};

Answered Ask(const wire::Command& command, const ControlOptions& options) {
  const auto port = OpenService(options.where, options.baud);
  hal::SystemClock clock;
  CommandClient client(options.where, *port, clock);
  const wire::Acknowledgement answer =
      client.Ask(command, Duration(static_cast<std::int64_t>(1e6 * options.timeout_s)));
  return {answer, client.text()};
}

// The answer's sentence, and the service's own words behind or, when they are several lines, below
// it.
std::string Sentence(const Answered& answered) {
  std::string sentence = app::AnswerText(answered.answer).data();
  if (answered.text.empty()) return sentence;
  const bool lines = answered.text.find('\n') != std::string::npos;
  return sentence + (lines ? ":\n" : ": ") + answered.text;
}

void Give(const wire::Command& command, const ControlOptions& options) {
  const Answered answered = Ask(command, options);
  const std::string text = Sentence(answered);
  if (!Succeeded(answered.answer.result)) throw app::Failure(text);
  std::printf("%s\n", text.c_str());
}

void Status(const ControlOptions& options) {
  const Answered answered = Ask({.code = wire::CommandCode::kReport}, options);
  if (!Succeeded(answered.answer.result)) throw app::Failure(Sentence(answered));
  if (options.json) {
    std::printf("%s\n", answered.text.c_str());
    return;
  }
  const auto report = ReportText(answered.text);
  if (!report) throw app::Failure(options.where + ": its report is not understood; see --json");
  std::fputs(report->c_str(), stdout);
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

namespace {

// A verb that is one command and its answer.
void AddVerb(CLI::App& facewire, const char* name, const char* help, wire::CommandCode code) {
  auto options = std::make_shared<ControlOptions>();
  CLI::App* command = facewire.add_subcommand(name, help);
  AddControlOptions(*command, *options);
  command->callback([options, code] { Give({.code = code}, *options); });
}

}  // namespace

void AddStatus(CLI::App& facewire) {
  auto options = std::make_shared<ControlOptions>();
  CLI::App* command = facewire.add_subcommand("status", "Show how the running service fares");
  command->add_flag("--json", options->json, "One JSON object, for programs");
  AddControlOptions(*command, *options);
  command->callback([options] { Status(*options); });
}

void AddService(CLI::App& facewire) {
  AddVerb(facewire, "neutral", "Have the running service ease to neutral and stay there",
          wire::CommandCode::kRest);
  AddVerb(facewire, "stop", "Emergency stop: nothing moves, over restarts too, until release",
          wire::CommandCode::kStop);
  AddVerb(facewire, "release", "End a stop, or a neutral that was asked for",
          wire::CommandCode::kRelease);
  AddVerb(facewire, "reload", "Have the running service read its configuration again",
          wire::CommandCode::kReload);
}

}  // namespace facewire::tools
