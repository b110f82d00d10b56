// facewire servo list: how all servos of a configuration are.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/animatronic/servo_output.h"
#include "app/animatronic/servo_words.h"
#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/json.h"
#include "tools/facewire/servo/installation.h"
#include "tools/facewire/servo/open.h"
#include "tools/facewire/servo/verbs.h"
#include "tools/facewire/servo/words.h"

namespace facewire::tools {
namespace {

struct ListOptions {
  std::string config = kUsualConfig;
  bool json = false;
};

// Time for a chain of many to have read all settings twice; who is silent then, is absent.
constexpr std::chrono::seconds kLongest(4);
constexpr std::chrono::milliseconds kLongestGoodbye(300);

bool IsKnown(const bus::ServoFeedback& said, bool reads_back) {
  if (said.state == bus::ServoState::kRefused) return true;
  const bool looked_at =
      said.state != bus::ServoState::kAbsent && said.state != bus::ServoState::kChecking;
  return looked_at && (!reads_back || said.temperature_c);
}

std::string Number(const char* format, std::optional<float> value, double scale = 1) {
  if (!value) return "-";
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), format, scale * static_cast<double>(*value));
  return text.data();
}

using Row = std::vector<std::string>;

Row RowOf(const servo::Servo& servo, const bus::ServoFeedback& said) {
  return {std::string(servo.name.view()),
          std::string(servo.bus.view()),
          std::to_string(servo.id),
          Name(said.state),
          Number("%.0f", said.position),
          Number("%g", servo.min) + ".." + Number("%g", servo.max),
          Number("%.0f C", said.temperature_c),
          Number("%.0f %%", said.load, 100),
          Number("%.1f V", said.voltage_v),
          app::FaultWords(said.faults).data()};
}

void PrintTable(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    std::printf("%s\n", line.c_str());
  }
}

void AppendOptional(std::string& out, const char* key, std::optional<float> value, int decimals) {
  out += std::string(",\"") + key + "\":";
  value ? json::AppendNumber(out, *value, decimals) : void(out += "null");
}

std::string JsonOf(const servo::Servo& servo, const bus::ServoFeedback& said,
                   const std::vector<std::string>& findings) {
  std::string out = "{\"servo\":";
  json::AppendString(out, servo.name.view());
  out += ",\"bus\":";
  json::AppendString(out, servo.bus.view());
  out += ",\"id\":";
  json::AppendInteger(out, servo.id);
  out += ",\"state\":";
  json::AppendString(out, Name(said.state));
  AppendOptional(out, "position", said.position, 2);
  AppendOptional(out, "min", servo.min, 2);
  AppendOptional(out, "max", servo.max, 2);
  AppendOptional(out, "temperature_c", said.temperature_c, 1);
  AppendOptional(out, "load", said.load, 3);
  AppendOptional(out, "voltage_v", said.voltage_v, 1);
  out += ",\"errors\":";
  json::AppendString(out, app::FaultWords(said.faults).data());
  out += ",\"findings\":[";
  for (std::size_t i = 0; i < findings.size(); ++i) {
    if (i > 0) out += ',';
    json::AppendString(out, findings[i]);
  }
  return out + "]}";
}

// The servos' findings by index, and what is wrong with buses as a whole.
struct Told {
  std::vector<std::vector<std::string>> findings;
  std::vector<std::string> buses;
};

Told Tell(const Installation& all, const app::ServoOutput& output, const std::string& config) {
  Told told;
  const auto& joined = output.animatronic();
  const auto& servos = all.servos.servos;
  told.findings.resize(servos.size());
  for (std::size_t b = 0; b < all.buses.size(); ++b) {
    const app::ServoBusConfig& bus = all.buses[b];
    if (const std::string text = BusText(joined.status(b), bus); !text.empty())
      told.buses.push_back(text);
    std::vector<std::size_t> on_bus;
    for (std::size_t i = 0; i < servos.size(); ++i) {
      if (joined.bus_of(i) != b) continue;
      on_bus.push_back(i);
      if (joined.feedback(i).state == bus::ServoState::kAbsent &&
          joined.status(b).fault == bus::BusFault::kNone) {
        told.findings[i].push_back("does not answer, though others of its bus do; is " +
                                   std::to_string(servos[i].id) + " its id?");
      }
    }
    for (const bus::Finding& finding : joined.status(b).findings) {
      const std::size_t i = on_bus[finding.servo];
      told.findings[i].push_back(FindingText(finding, servos[i].name.view(), bus, config));
    }
  }
  return told;
}

void List(const ListOptions& options) {
  const Installation all = WithServos(LoadInstallation(options.config));
  const auto& servos = all.servos.servos;
  hal::SystemClock clock;
  app::ServoOutput output(all.buses, all.servos, clock);
  OpenOutput(output);
  // Nobody is told to go anywhere: the drivers look at their servos, and leave them limp.
  const auto& joined = output.animatronic();
  const auto known = [&] {
    for (std::size_t i = 0; i < servos.size(); ++i) {
      const auto kind = FindBus(all, servos[i].bus.view()).kind;
      const bool reads_back = kind == app::BusKind::kDynamixel || kind == app::BusKind::kFeetech;
      if (!IsKnown(joined.feedback(i), reads_back)) return false;
    }
    return true;
  };
  Time next = clock.Now();
  for (const Time end = next + kLongest; next < end && !known();) {
    output.Tick();
    next += output.period();
    clock.SleepUntil(next);
  }
  const Told told = Tell(all, output, options.config);
  std::vector<Row> rows = {
      {"servo", "bus", "id", "state", "position", "min..max", "heat", "load", "voltage", "errors"}};
  for (std::size_t i = 0; i < servos.size(); ++i) {
    if (options.json) {
      std::printf("%s\n", JsonOf(servos[i], joined.feedback(i), told.findings[i]).c_str());
    } else {
      rows.push_back(RowOf(servos[i], joined.feedback(i)));
    }
  }
  output.Close(kLongestGoodbye);
  if (options.json) return;
  PrintTable(rows);
  for (std::size_t i = 0; i < servos.size(); ++i) {
    for (const std::string& finding : told.findings[i]) {
      std::printf("%s: %s\n", std::string(servos[i].name.view()).c_str(), finding.c_str());
    }
  }
  for (const std::string& text : told.buses) std::printf("%s\n", text.c_str());
}

}  // namespace

void AddServoList(CLI::App& servo) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = servo.add_subcommand(
      "list", "How every servo is: position, heat, load, voltage, errors, settings");
  AddConfigOption(*command, options->config);
  command->add_flag("--json", options->json, "A JSON object a line instead of a table");
  command->footer(
      "Below the table stands each setting that is not as the rig needs it, and the command that "
      "mends it. Servos are\n"
      "left limp.");
  command->callback([options] { List(*options); });
}

}  // namespace facewire::tools
