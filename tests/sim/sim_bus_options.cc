#include "tests/sim/sim_bus_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/sim/dynamixel.h"
#include "tests/sim/feetech.h"
#include "tests/sim/maestro.h"

namespace facewire::sim {
namespace {

constexpr double kChainBaud = 1'000'000;

struct Given {
  std::string kind;
  std::size_t servos = 0;  // 0: the kind's own number
  std::vector<int> ids;
  std::string link, trace, pose = "middle", home = "off";
  double baud = 0;  // 0: the kind's own
  double supply_V = 0, supply_ohm = 0.05, gravity_Nm = 0, seconds = 0, random_faults = 0;
  std::vector<std::string> faults;
  std::uint64_t seed = 1;
  bool crc = false;
  bool echo = false;
  bool strict_baud = false;
  int timeout_ms = 0;
  int device = 12;
};

[[noreturn]] void Refuse(const std::string& what) { throw std::runtime_error(what); }

void DeclareShared(CLI::App& app, Given& given) {
  app.add_option("--link", given.link, "where to put the link to the line")->required();
  app.add_option("--pose", given.pose,
                 "where the servos are at power-on: middle, random, or a position for all");
  app.add_option("--gravity", given.gravity_Nm, "torque of a level arm on every servo, Nm");
  app.add_option("--supply", given.supply_V, "volts (default: what the servos are made for)");
  app.add_option("--supply-ohm", given.supply_ohm, "resistance that all servos share");
  app.add_option("--trace", given.trace, "CSV file of what the servos do, written as it happens");
  app.add_option(
      "--fault", given.faults,
      "NAME=NUMBER for the line: lose, flip, duplicate, late (chances), late-ms, noise (a "
      "second); NAME:SERVO@START[+LASTS][=VALUE] for a servo: vanish, mute, brownout, jam, "
      "hot, jump; seconds, servos from 0; may be given again");
  app.add_option("--random-faults", given.random_faults, "so many of the servos' faults a minute");
  app.add_option("--seed", given.seed, "of everything that is left to chance");
  app.add_option("--seconds", given.seconds, "ends after this time (default: on a signal)");
}

void Declare(CLI::App& app, Given& given) {
  app.add_option("KIND", given.kind, "maestro, xl330, xl430 (Dynamixel), sts or scs (Feetech)")
      ->required();
  DeclareShared(app, given);
  app.add_option(
         "--servos", given.servos,
         "how many; a Maestro has 6, 12, 18 or 24 channels (default 6), a chain's servos get "
         "the ids from 1 (default 4)")
      ->check(CLI::Range(1, 252));
  app.add_option("--ids", given.ids, "the ids of a chain's servos, such as 1,2,7")->delimiter(',');
  app.add_option(
      "--baud", given.baud,
      "of the line (default 1000000 on chains; on a Maestro's USB port it does not matter)");
  app.add_flag("--echo", given.echo, "the host gets its own bytes back, too");
  app.add_flag("--strict-baud", given.strict_baud,
               "servos of a chain hear only a host that has set their own baud rate on the line");
  app.add_flag("--crc", given.crc, "Maestro: packets end with a CRC");
  app.add_option("--timeout-ms", given.timeout_ms, "Maestro: serial timeout, 0 is off");
  app.add_option("--device", given.device, "Maestro: device number");
  app.add_option("--home", given.home, "Maestro: off, ignore, or a pulse in us for all channels");
}

double Number(const std::string& text, const std::string& what) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || text.empty() || !std::isfinite(value)) Refuse(what);
  return value;
}

std::vector<std::uint8_t> Ids(const Given& given) {
  std::vector<std::uint8_t> ids;
  if (!given.ids.empty() && given.servos != 0) Refuse("give --servos or --ids, not both");
  for (const int id : given.ids) {
    if (id < 0 || id > 252) Refuse("--ids: " + std::to_string(id) + " is not an id from 0 to 252");
    ids.push_back(static_cast<std::uint8_t>(id));
  }
  if (std::set<std::uint8_t>(ids.begin(), ids.end()).size() != ids.size()) {
    Refuse("--ids: an id is there twice");
  }
  if (!ids.empty()) return ids;
  const std::size_t count = given.servos == 0 ? 4 : given.servos;
  for (std::size_t i = 1; i <= count; ++i) ids.push_back(static_cast<std::uint8_t>(i));
  return ids;
}

// What all kinds share; positions of the servos go from `low` to `high` in their own unit.
void Fill(const Given& given, std::size_t servos, double low, double high, BusOptions& options) {
  if (given.baud != 0) options.baud = given.baud;
  if (given.supply_V != 0) options.supply_V = given.supply_V;
  options.supply_ohm = given.supply_ohm;
  options.echo = given.echo;
  options.seed = given.seed;
  const double middle = (low + high) / 2;
  Random random(given.seed);
  for (std::size_t i = 0; i < servos; ++i) {
    if (given.pose == "random") {
      options.poses.push_back(random.Between((low + middle) / 2, (high + middle) / 2));
    } else if (given.pose != "middle") {
      options.poses.push_back(
          Number(given.pose, "--pose: '" + given.pose + "' is not middle, random or a position"));
      if (options.poses.back() < low || options.poses.back() > high) {
        Refuse("--pose: a servo goes from " + std::to_string(static_cast<int>(low)) + " to " +
               std::to_string(static_cast<int>(high)));
      }
    }
    options.loads.push_back({.gravity_Nm = given.gravity_Nm, .gravity_down_rad = -90 * kDegree});
  }
  for (const std::string& text : given.faults) {
    if (const auto why = AddFault(text, options.faults)) Refuse("--fault: " + *why);
  }
  for (const Fault& fault : options.faults.faults) {
    if (fault.servo >= servos) {
      Refuse("--fault: there is no servo " + std::to_string(fault.servo) + ", they go from 0 to " +
             std::to_string(servos - 1));
    }
  }
  if (given.random_faults > 0) {
    for (const Fault& fault :
         RandomFaults(given.seed, servos, std::chrono::hours(10), given.random_faults, low, high)) {
      options.faults.faults.push_back(fault);
    }
  }
}

std::unique_ptr<Bus> MakeMaestro(const Given& given) {
  if (!given.ids.empty()) Refuse("--ids: a Maestro's servos have channels, no ids");
  MaestroOptions options;
  options.model = given.servos == 0 ? 6 : given.servos;
  if (options.model != 6 && options.model != 12 && options.model != 18 && options.model != 24) {
    Refuse("--servos: a Maestro has 6, 12, 18 or 24 channels");
  }
  if (given.timeout_ms < 0) Refuse("--timeout-ms: a time cannot be negative");
  if (given.device < 0 || given.device > 127) Refuse("--device: from 0 to 127");
  options.crc = given.crc;
  options.serial_timeout = std::chrono::milliseconds(given.timeout_ms);
  options.device_number = static_cast<std::uint8_t>(given.device);
  MaestroChannel channel;
  if (given.home == "ignore") {
    channel.home = MaestroHome::kIgnore;
  } else if (given.home != "off") {
    channel.home = MaestroHome::kGoTo;
    channel.home_us =
        Number(given.home, "--home: '" + given.home + "' is not off, ignore or a pulse in us");
    if (channel.home_us < channel.minimum_us || channel.home_us > channel.maximum_us) {
      Refuse("--home: a channel goes from 992 to 2000 us");
    }
  }
  options.channels.assign(options.model, channel);
  Fill(given, options.model, 500, 2500, options);
  return std::make_unique<Maestro>(options);
}

std::unique_ptr<Bus> MakeDynamixel(const Given& given, const DynamixelModel& model) {
  DynamixelOptions options(model);
  options.ids = Ids(given);
  options.baud = kChainBaud;
  Fill(given, options.ids.size(), 0, 4095, options);
  return std::make_unique<Dynamixel>(options);
}

std::unique_ptr<Bus> MakeFeetech(const Given& given, const FeetechSeries& series) {
  FeetechOptions options(series);
  options.ids = Ids(given);
  options.baud = kChainBaud;
  Fill(given, options.ids.size(), 0, series.counts - 1, options);
  return std::make_unique<Feetech>(options);
}

void CheckShared(const Given& given) {
  if (given.supply_V < 0 || given.supply_V > 60) Refuse("--supply: from 0 to 60 V");
  if (given.supply_ohm < 0 || given.supply_ohm > 100) Refuse("--supply-ohm: from 0 to 100");
  if (given.seconds < 0 || given.seconds > 1e6) Refuse("--seconds: from 0 to 1000000");
  if (given.random_faults < 0 || given.random_faults > 100)
    Refuse("--random-faults: from 0 to 100");
}

std::unique_ptr<Bus> Make(const Given& given) {
  if (given.strict_baud && given.kind == "maestro") {
    Refuse("--strict-baud: a Maestro's USB port does not mind the rate");
  }
  if (given.baud != 0 && !(given.baud >= 1200 && given.baud <= 10e6)) {
    Refuse("--baud: from 1200 to 10000000");
  }
  CheckShared(given);
  if (given.kind == "maestro") return MakeMaestro(given);
  if (given.kind == "xl330") return MakeDynamixel(given, Xl330());
  if (given.kind == "xl430") return MakeDynamixel(given, Xl430());
  if (given.kind == "sts") return MakeFeetech(given, Sts());
  if (given.kind == "scs") return MakeFeetech(given, Scs());
  Refuse("KIND: '" + given.kind + "' is not maestro, xl330, xl430, sts or scs");
}

// Reads the command line and makes the bus; what went wrong is one line of `program`.
SimBusOptions Parse(CLI::App& app, const Given& given,
                    const std::function<std::unique_ptr<Bus>()>& make, int count,
                    const char* const* arguments, int& exit_code) {
  SimBusOptions options;
  try {
    app.parse(count, arguments);
    options.bus = make();
  } catch (const CLI::Success& help) {
    exit_code = app.exit(help);
    return options;
  } catch (const std::exception& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), what.c_str());
    exit_code = 2;
    return options;
  }
  options.link = given.link;
  options.trace = given.trace;
  options.strict_baud = given.strict_baud;
  options.runs = Duration(static_cast<Duration::rep>(given.seconds * 1e6));
  options.about = (given.kind.empty() ? "" : given.kind + " with ") +
                  std::to_string(options.bus->servos()) + " servos";
  return options;
}

}  // namespace

SimBusOptions ParseSimBusOptions(int count, const char* const* arguments, int& exit_code) {
  CLI::App app("A simulated servo bus on a pseudo-terminal, in real time.", "sim_bus");
  Given given;
  Declare(app, given);
  return Parse(
      app, given, [&] { return Make(given); }, count, arguments, exit_code);
}

SimBusOptions ParseSimBusOptions(const OwnProgram& program, int count, const char* const* arguments,
                                 int& exit_code) {
  CLI::App app(program.description, program.name);
  Given given;
  given.servos = program.most_servos;
  DeclareShared(app, given);
  app.add_option("--servos", given.servos, "how many (default: all that it can have)")
      ->check(CLI::Range(std::size_t{1}, program.most_servos));
  const auto make = [&] {
    CheckShared(given);
    BusOptions options;
    Fill(given, given.servos, program.low, program.high, options);
    return program.make(options, given.servos);
  };
  return Parse(app, given, make, count, arguments, exit_code);
}

}  // namespace facewire::sim
