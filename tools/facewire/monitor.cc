#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "app/devices.h"
#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/full_screen.h"
#include "tools/facewire/monitor_recorder.h"
#include "tools/facewire/monitor_session.h"
#include "tools/facewire/stop_flag.h"
#include "tools/facewire/stream_port.h"

namespace facewire::tools {
namespace {

struct Options {
  std::string port;
  int baud = 115200;
  double seconds = 0;
  std::uint64_t frames = 0;
  std::string csv;
  std::string jsonl;
  bool plain = false;
  bool summary = false;
  bool ascii = false;
  bool listen = false;
};

ScreenSize TerminalSize() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return {};
  return {size.ws_col, size.ws_row};
}

// As the C library finds the locale, but without its tables: a small board often has only
// "C.UTF-8".
bool LocaleIsUtf8() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(variable);
    if (value == nullptr || *value == '\0') continue;
    std::string text;
    for (const char* c = value; *c != '\0'; ++c) {
      if (*c != '-') text += static_cast<char>(std::tolower(static_cast<unsigned char>(*c)));
    }
    return text.find("utf8") != std::string::npos;
  }
  return false;
}

// Nothing sound at all is not a quiet success: a script, and a person, should notice.
void RequireFrames(const MonitorModel& model, MonitorEnd end) {
  if (model.link.frames > 0 || end == MonitorEnd::kInterrupted) return;
  const std::string found = std::to_string(model.bytes) + " bytes, but no facewire frame";
  if (!model.note.empty()) throw app::BadInput(model.port + ": " + model.note);
  if (end == MonitorEnd::kEndOfFile) throw app::BadInput(model.port + " holds " + found);
  throw app::Failure(model.port + ": " + found + " arrived" +
                     (model.bytes > 0 ? "; is the baud rate right?" : "; is the device sending?"));
}

void Monitor(const Options& options) {
  std::optional<MonitorRecorder> recorder;
  const auto port = MakeLine(options.port, options.baud);
  app::OpenSerialPort(*port, options.port, options.baud);
  // Before the recorder: it would otherwise end the program on a signal.
  const StopFlag stop;
  if (!options.csv.empty()) recorder.emplace(options.csv, MonitorRecorder::Form::kCsv);
  if (!options.jsonl.empty()) recorder.emplace(options.jsonl, MonitorRecorder::Form::kJsonl);

  MonitorDisplay display;
  display.write = WriteOut;
  display.size = TerminalSize;
  const bool terminal = isatty(STDOUT_FILENO) == 1;
  display.style.unicode = !options.ascii && LocaleIsUtf8();
  const char* no_colour = std::getenv("NO_COLOR");  // no-color.org: any value but an empty one
  display.style.colour = no_colour == nullptr || *no_colour == '\0';
  if (options.summary) {
    display.kind = MonitorDisplay::Kind::kNone;
  } else {
    display.kind =
        terminal && !options.plain ? MonitorDisplay::Kind::kScreen : MonitorDisplay::Kind::kPlain;
  }

  MonitorLimits limits;
  if (options.seconds > 0) limits.seconds = options.seconds;
  if (options.frames > 0) limits.frames = options.frames;
  limits.may_write = !options.listen;

  hal::SystemClock clock;
  const auto session =
      std::make_unique<MonitorSession>(options.port == "-" ? "standard input" : options.port, *port,
                                       clock, display, recorder ? &*recorder : nullptr);
  MonitorEnd end{};
  {
    std::optional<FullScreen> screen;
    if (display.kind == MonitorDisplay::Kind::kScreen) screen.emplace();
    end = session->Run(limits, [&] { return stop.Raised(); });
  }
  const MonitorModel& model = session->model();
  RequireFrames(model, end);
  WriteOut(SummaryText(model));
  if (end == MonitorEnd::kClosed) WriteOut("the other side closed the line\n");
  if (recorder) {
    recorder->Finish(model.rig);
    WriteOut(std::to_string(recorder->recorded()) + " poses recorded in " + options.csv +
             options.jsonl + "\n");
    if (recorder->of_other_rigs() > 0) {
      WriteOut(std::to_string(recorder->of_other_rigs()) +
               " poses of another rig were not recorded\n");
    }
  }
}

}  // namespace

void AddMonitor(CLI::App& facewire) {
  auto* command = facewire.add_subcommand(
      "monitor", "Decode the wire live: every channel as a bar, and how the line fares");
  const auto options = std::make_shared<Options>();
  command
      ->add_option(
          "PORT", options->port,
          "A serial port, a pseudo-terminal, a recorded file, a FIFO, or - (standard input)")
      ->required();
  command->add_option("--baud", options->baud, "Bits a second of a serial port")
      ->capture_default_str()
      ->check(CLI::Range(300, 4'000'000));
  command->add_option("--seconds", options->seconds, "End after so long")
      ->check(CLI::PositiveNumber);
  command->add_option("--frames", options->frames, "End after so many poses")
      ->check(CLI::PositiveNumber);
  auto* csv = command->add_option("--csv", options->csv, "Record the poses in this file");
  command->add_option("--jsonl", options->jsonl, "Record the poses as a JSON object a line")
      ->excludes(csv);
  command->add_flag("--plain", options->plain, "A line a second instead of the screen");
  command->add_flag("--summary", options->summary, "Only the counts at the end");
  command->add_flag("--ascii", options->ascii, "Draw with ASCII characters alone");
  command->add_flag("--listen", options->listen, "Never write: do not ask for the rig description");
  command->callback([options] { Monitor(*options); });
}

}  // namespace facewire::tools
