// facewired: a camera looks at a performer, and a character's face moves.

#include <sys/mman.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "app/application.h"
#include "app/error.h"
#include "app/journal.h"
#include "hal/system_clock.h"

namespace {

using facewire::app::Application;

facewire::app::Requests g_requests;  // handlers reach nothing else

void OnQuit(int /*signal*/) { g_requests.quit.fetch_add(1); }
void OnReload(int /*signal*/) { g_requests.reload.store(true); }

void Handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigaction(signal, &action, nullptr);
}

int Main(int argc, char** argv, facewire::app::Journal& journal) {
  facewire::app::ApplicationOptions options;
  bool check = false;
  bool memory = false;
  double seconds = 0;
  std::string stats_json;
  CLI::App cli{"Follows a performer's face and sends it to a character's rig."};
  cli.add_option("--config", options.config, "The configuration file (facewire.toml)")->required();
  cli.add_flag("--fake", options.fake,
               "Mock hardware: the configured recording, a pseudo-terminal");
  cli.add_flag("--read-only", options.read_only, "Follow, but send nothing to a host");
  cli.add_flag("--check", check, "Check the configuration and all its files, then end");
  cli.add_flag("--memory", memory, "Print the memory budget part by part, then end");
  cli.add_option("--seconds", seconds, "End, by way of neutral, after so long")
      ->check(CLI::Range(0.0, 1e9));
  cli.add_option("--stats-json", stats_json, "Write what the run came to into this file");
  cli.set_version_flag("--version", "facewired " FACEWIRE_VERSION);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return cli.exit(e);
    std::fprintf(stderr, "facewired: %s; see facewired --help\n", e.what());
    return 2;
  }

  facewire::hal::SystemClock clock;
  Application application(options, clock, journal);
  if (check || memory) {
    if (check) std::fputs(application.Summary().c_str(), stdout);
    if (memory) std::fputs(Table(application.Memory()).c_str(), stdout);
    return 0;
  }
  // Until here a signal ends the program at once: nothing moves yet.
  Handle(SIGTERM, OnQuit);
  Handle(SIGINT, OnQuit);
  Handle(SIGHUP, OnReload);
  application.Open();
  // What is in memory stays there: a frame must not wait for a disk. Without the right to do so (a
  // developer's laptop) nothing is lost but that promise.
  if (!options.fake) (void)::mlockall(MCL_CURRENT);
  application.Run(g_requests, facewire::Duration(static_cast<std::int64_t>(seconds * 1e6)));
  const facewire::app::RunReport report = application.Report();
  if (!stats_json.empty()) WriteJson(stats_json, report);
  // Under systemd both would be the journal.
  if (journal.structured()) {
    journal.Write(facewire::app::Event::kEnded, Summary(report));
  } else {
    std::printf("facewired: %s\n", Summary(report).c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  facewire::app::Journal journal;
  try {
    return Main(argc, argv, journal);
  } catch (const facewire::app::BadInput& e) {
    journal.Write(facewire::app::Event::kBadInput, e.what());
    return 2;
  } catch (const std::exception& e) {
    journal.Write(facewire::app::Event::kFailure, e.what());
    return 1;
  }
}
