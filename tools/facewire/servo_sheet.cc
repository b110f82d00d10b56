#include "tools/facewire/servo_sheet.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "app/config.h"
#include "app/error.h"
#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "tools/facewire/following.h"
#include "tools/facewire/recording.h"
#include "tools/sheet/traces.h"

namespace facewire::tools {
namespace {

using app::BadInput;
using app::BusKind;

// NAME=TRACE:INDEX
struct Choice {
  std::string name;
  std::string trace;
  int index = 0;
};

Choice ParseChoice(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.rfind(':');
  Choice choice;
  if (equals != std::string::npos && colon != std::string::npos && colon > equals) {
    choice.name = text.substr(0, equals);
    choice.trace = text.substr(equals + 1, colon - equals - 1);
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, choice.index);
    if (error == std::errc{} && stop == end && choice.index >= 0) return choice;
  }
  throw BadInput("--servo " + text + ": NAME=TRACE:INDEX would be right, as jaw=mouth.csv:0");
}

const app::ServoBusConfig& BusOf(const servo::Servo& servo, const app::Config& config,
                                 const std::string& file) {
  const auto bus = std::ranges::find(config.buses, servo.bus.view(), &app::ServoBusConfig::name);
  if (bus == config.buses.end()) {
    throw BadInput(file + ": no [[bus]] \"" + std::string(servo.bus.view()) + "\", which servo \"" +
                   std::string(servo.name.view()) + "\" is on");
  }
  return *bus;
}

bool HasPulses(BusKind kind) { return kind == BusKind::kMaestro || kind == BusKind::kReceiver; }
// What such a bus resolves; the receiver's own figure is in tools/firmware/README.md.
double StepOf(BusKind kind) {
  if (kind == BusKind::kReceiver) return 0.5;
  return kind == BusKind::kMaestro ? 0.25 : 1;
}

// The kind and number of a servo as people say it.
std::string AddressOf(const servo::Servo& servo, const app::ServoBusConfig& bus) {
  const char* number =
      HasPulses(bus.kind) ? (bus.kind == BusKind::kMaestro ? "channel" : "output") : "id";
  return "bus \"" + bus.name + "\": " + Name(bus.kind) + ", " + number + " " +
         std::to_string(servo.id);
}

// Two of the channels at most, a line each.
std::vector<std::string> SourcesOf(const servo::Servo& servo) {
  constexpr std::size_t kMost = 2;
  std::vector<std::string> lines;
  for (const servo::Source& source : servo.sources) {
    if (lines.size() == kMost) {
      lines.back() += ", ...";
      break;
    }
    const char* const sign = source.gain < 0 ? "- " : "+ ";
    const double size = std::abs(static_cast<double>(source.gain));
    lines.push_back((lines.empty() ? (source.gain < 0 ? "from - " : "from ") : sign) +
                    (size == 1 ? "" : Number("%g ", size)) + std::string(source.channel.view()));
  }
  return lines;
}

// Where the poses want the servo, at the times when they were sent.
Curve ParameterOf(const servo::Servo& servo, const Rig& rig, const std::vector<RecordedPose>& poses,
                  double start_s) {
  Curve curve;
  for (const RecordedPose& recorded : poses) {
    double sum = 0;
    for (const servo::Source& source : servo.sources) {
      const auto channel = rig.FindChannel(source.channel.view());
      sum += static_cast<double>(source.gain * recorded.pose.values[*channel]);
    }
    const auto sent = recorded.pose.captured + std::chrono::microseconds(recorded.age_us);
    curve.push_back({std::chrono::duration<double>(sent.time_since_epoch()).count() - start_s,
                     std::clamp<double>(servo.PositionOf(sum), servo.min, servo.max)});
  }
  return curve;
}

std::string Lag(const Following& following) {
  return std::isnan(following.lag_ms) ? "-" : Number("%.0f ms", following.lag_ms);
}

TraceLane LaneOf(const servo::Servo& servo, const app::ServoBusConfig& bus, Curve parameter,
                 const std::vector<ServoRow>& rows, const ServoFollowing& following) {
  TraceLane lane;
  lane.title = servo.name.view();
  lane.subtitle = SourcesOf(servo);
  lane.subtitle.insert(lane.subtitle.begin(), AddressOf(servo, bus));
  lane.unit = HasPulses(bus.kind) ? "us" : "counts";
  const auto words = [&](const char* what, const Following& f) {
    return std::string(what) + " " + Lag(f) + " behind,";
  };
  const auto off = [&](const Following& f) {
    return "   then off by " + Number("%.1f", f.rms) + " rms, " + Number("%.0f", f.largest) +
           " at most";
  };
  lane.remarks = {
      words("command", following.command), off(following.command),
      words("position", following.position), off(following.position),
      "at rest the bus is " + Number("%.2f ", following.unresolved) + lane.unit + " off"};
  lane.low = static_cast<double>(servo.min);
  lane.high = static_cast<double>(servo.max);
  lane.parameter = std::move(parameter);
  for (const ServoRow& row : rows) {
    lane.command.push_back({row.t_s, row.torque_on ? row.goal : NAN});
    lane.position.push_back({row.t_s, row.position});
  }
  lane.close_up = following.liveliest;
  return lane;
}

std::string TableLine(const std::string& name, const std::string& bus, const Following& command,
                      const Following& position, const std::string& rest) {
  std::array<char, 200> line{};
  std::snprintf(line.data(), line.size(), "  %-16s %-10s %8s %8.2f %8.1f  %8s %8.2f %8.1f  %s\n",
                name.c_str(), bus.c_str(), Lag(command).c_str(), command.rms, command.largest,
                Lag(position).c_str(), position.rms, position.largest, rest.c_str());
  return line.data();
}

constexpr const char* kTableHead =
    "                                behind parameter, then off    behind command, then off\n"
    "  servo            bus             lag      rms     most       lag      rms     most  at "
    "rest\n";

double Median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return NAN;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

ServoSheet SheetOfServos(const ServoSheetOptions& options) {
  const app::Config config = app::LoadConfig(options.config);
  const Rig rig = app::LoadRig(config.character.rig);
  const servo::ServoRig servos = app::LoadServoRig(config.character.rig, rig);
  const std::vector<RecordedPose> poses = ReadEveryPose(options.recording, rig);
  const double start_s =
      std::chrono::duration<double>(poses.front().pose.captured.time_since_epoch()).count();

  ServoSheet sheet;
  sheet.table = kTableHead;
  std::vector<TraceLane> lanes;
  std::vector<double> command_lags;
  std::vector<double> position_lags;
  std::vector<std::string> buses;
  double end_s = 0;
  for (const std::string& text : options.servos) {
    const Choice choice = ParseChoice(text);
    const auto at = servos.Find(choice.name);
    if (!at) {
      throw BadInput("--servo " + text + ": the rig " + config.character.rig.string() +
                     " has no servo \"" + choice.name + "\"");
    }
    const servo::Servo& servo = servos.servos[*at];
    if (servo.sources.empty()) {
      throw BadInput("--servo " + text + ": no channel moves it, so there is nothing to follow");
    }
    const app::ServoBusConfig& bus = BusOf(servo, config, options.config);
    std::vector<ServoRow> rows = ReadServoRows(choice.trace, choice.index);
    for (ServoRow& row : rows) {
      row.t_s -= start_s;
      // A pulse of 0 is none; the servo notices two periods later.
      if (HasPulses(bus.kind) && row.goal == 0) row.torque_on = false;
    }
    Curve parameter = ParameterOf(servo, rig, poses, start_s);
    if (rows.front().t_s > parameter.back().t_s || rows.back().t_s < parameter.front().t_s) {
      throw BadInput(choice.trace + " and " + options.recording +
                     " have no time in common; both must be of one run on one machine");
    }
    const ServoFollowing following = Measure(servo, parameter, rows);
    if (const std::string why = WhyNot(servo, following, StepOf(bus.kind)); !why.empty()) {
      sheet.strayed.push_back(choice.name + " " + why);
    }
    command_lags.push_back(following.command.lag_ms);
    position_lags.push_back(following.position.lag_ms);
    if (std::ranges::find(buses, bus.name) == buses.end()) buses.push_back(bus.name);
    end_s = std::max({end_s, rows.back().t_s, parameter.back().t_s});
    lanes.push_back(LaneOf(servo, bus, std::move(parameter), rows, following));
    sheet.table += TableLine(choice.name, Name(bus.kind), following.command, following.position,
                             Number("%.2f ", following.unresolved) + lanes.back().unit +
                                 (following.torque_at_end ? ", torque on at the end" : ""));
  }
  const std::array figures{
      Figure{Number("%.1f s", end_s), "one clip, one run"},
      Figure{std::to_string(buses.size()), "servo buses at once"},
      Figure{std::to_string(lanes.size()), "servos shown"},
      Figure{Number("%.0f ms", Median(command_lags)), "pose to command, median"},
      Figure{Number("%.0f ms", Median(position_lags)), "command to position, median"},
      Figure{std::to_string(sheet.strayed.size()), "servos that did not follow"}};
  sheet.picture = DrawTraces("what the rig asked for, what each bus was told, what each servo did",
                             figures, lanes, {0, end_s});
  return sheet;
}

}  // namespace facewire::tools
