// facewire servo find: which servo buses are there.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/devices.h"
#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/servo/open.h"
#include "tools/facewire/servo/search.h"
#include "tools/facewire/servo/verbs.h"

namespace facewire::tools {
namespace {

struct FindOptions {
  std::vector<std::string> ports;
  std::vector<std::string> kinds;
  std::vector<int> rates;
  bool all = false;
  bool quiet = false;
};

SearchPlan PlanOf(const FindOptions& options) {
  SearchPlan plan;
  plan.rates = options.rates;
  plan.all_ids = options.all;
  if (options.kinds.empty()) return plan;
  std::erase_if(plan.protocols, [&](Protocol protocol) {
    return std::ranges::find(options.kinds, KindOf(protocol)) == options.kinds.end();
  });
  return plan;
}

void Print(const FoundBus& bus, std::size_t number) {
  const std::string name = "bus" + (number > 1 ? std::to_string(number) : std::string());
  std::printf("%s\nfor facewire.toml:\n\n%s\n", Describe(bus).c_str(), BusBlock(bus, name).c_str());
}

void Find(const FindOptions& options) {
  const SearchPlan plan = PlanOf(options);
  const std::vector<std::string> ports = options.ports.empty() ? SerialPorts() : options.ports;
  if (ports.empty()) {
    throw app::Failure(
        "no serial port is there; plug the servos' adapter in (dmesg shows whether it is seen)");
  }
  hal::SystemClock clock;
  std::size_t buses = 0;
  for (const std::string& port : ports) {
    PortSearch search;
    try {
      search = SearchPort(
          port, [&](int baud) { return app::MakeSerialPort(port, baud); }, clock, plan,
          [&](const std::string& step) {
            if (!options.quiet) std::fprintf(stderr, "%s\n", step.c_str());
          });
    } catch (const app::BadInput& error) {
      if (ports.size() == 1) throw app::BadInput(WithService(error.what()));
      std::printf("%s\n", WithService(error.what()).c_str());
      continue;
    }
    for (const FoundBus& bus : search.buses) Print(bus, ++buses);
    if (!search.buses.empty()) continue;
    std::printf("%s: no servos; tried were\n", port.c_str());
    for (const std::string& tried : search.tried) std::printf("  %s\n", tried.c_str());
  }
  if (buses == 0) {
    throw app::Failure(std::string("no servo bus was found; are the servos powered? ") +
                       (options.all ? "" : "--all asks every id of a Feetech chain"));
  }
}

}  // namespace

void AddServoFind(CLI::App& servo) {
  auto options = std::make_shared<FindOptions>();
  CLI::App* command = servo.add_subcommand(
      "find", "Which servo buses and servos are there, by asking; nothing moves");
  command->add_option("PORT", options->ports,
                      "Serial ports; without any, every one of this machine");
  command
      ->add_option("--kind", options->kinds, "Only buses of this kind; may be given more than once")
      ->check(CLI::IsMember({"receiver", "maestro", "dynamixel", "feetech"}))
      ->allow_extra_args(false);
  command
      ->add_option("--baud", options->rates,
                   "Only this rate instead of the usual ones; may be given more than once")
      ->check(CLI::Range(1200, 10'000'000))
      ->allow_extra_args(false);
  command->add_flag("--all", options->all,
                    "Ask every id of a Feetech chain, not only 0 to 20: half a minute a port");
  command->add_flag("--quiet", options->quiet, "Do not say what is being tried");
  command->footer(
      "Searched for are facewire's receiver firmware, Pololu Maestros, Dynamixels (protocol 2.0) "
      "and Feetech servos\n"
      "(STS, SMS, SCS), at their usual rates: ten seconds a port. Only questions are sent. A "
      "Maestro has to be in the\n"
      "serial mode USB Dual Port to be found by USB.");
  command->callback([options] { Find(*options); });
}

}  // namespace facewire::tools
