#include "tools/facewire/servo/installation.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "app/config.h"
#include "app/error.h"
#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "app/toml_reader.h"

namespace facewire::tools {
namespace {

// Slow enough to let go of a key in time, with a servo that is being tried for the first time.
constexpr float kSecondsForTheWholeWay = 20;
constexpr float kSecondsToFullSpeed = 0.5F;

constexpr WholeWay kPulses{500, 2500};
constexpr WholeWay kTurn{0, 4095};
constexpr WholeWay kScsTurn{0, 1023};  // 300 degrees

}  // namespace

Installation LoadInstallation(const std::filesystem::path& config) {
  const app::Config read = app::LoadConfig(config);
  if (read.buses.empty()) {
    throw app::BadInput(config.string() +
                        " has no [[bus]]; `facewire servo find` prints one for every bus there is");
  }
  const Rig rig = app::LoadRig(read.character.rig);
  return {.rig_file = read.character.rig,
          .control = read.control.socket,
          .buses = read.buses,
          .servos = app::LoadServoRig(read.character.rig, rig)};
}

Installation WithServos(Installation all) {
  if (all.servos.servos.empty()) {
    throw app::BadInput(all.rig_file.string() +
                        " has no [[servo]]; `facewire servo wizard` helps to write them");
  }
  std::erase_if(all.buses, [&](const app::ServoBusConfig& bus) {
    return std::ranges::none_of(all.servos.servos,
                                [&](const auto& servo) { return servo.bus.view() == bus.name; });
  });
  return all;
}

std::size_t FindServo(const Installation& installation, std::string_view name) {
  if (const auto at = installation.servos.Find(name)) return *at;
  std::vector<std::string> names;
  for (const servo::Servo& servo : installation.servos.servos)
    names.emplace_back(servo.name.view());
  throw app::BadInput("no servo \"" + std::string(name) + "\" in " +
                      installation.rig_file.string() + app::Suggestion(name, names));
}

const app::ServoBusConfig& FindBus(const Installation& installation, std::string_view name) {
  const auto found = std::ranges::find(installation.buses, name, &app::ServoBusConfig::name);
  if (found != installation.buses.end()) return *found;
  std::vector<std::string> names;
  for (const app::ServoBusConfig& bus : installation.buses) names.push_back(bus.name);
  throw app::BadInput("no [[bus]] \"" + std::string(name) + "\" in the configuration" +
                      app::Suggestion(name, names));
}

Installation PartOf(const Installation& all, std::size_t servo) {
  std::set<std::size_t> kept = {servo};
  for (std::size_t before = 0; before != kept.size();) {
    before = kept.size();
    for (const servo::Linkage& rule : all.servos.linkages) {
      if (!kept.contains(rule.yields) && !kept.contains(rule.other)) continue;
      kept.insert({rule.yields, rule.other});
    }
  }
  Installation part{.rig_file = all.rig_file, .control = {}, .buses = {}, .servos = {}};
  part.servos.contract = all.servos.contract;
  part.servos.following = all.servos.following;
  std::vector<std::uint8_t> place(all.servos.servos.size());
  for (const std::size_t i : kept) {
    place[i] = static_cast<std::uint8_t>(part.servos.servos.size());
    (void)part.servos.servos.try_push(all.servos.servos[i]);
  }
  for (servo::Linkage rule : all.servos.linkages) {
    if (!kept.contains(rule.yields)) continue;
    rule.yields = place[rule.yields];
    rule.other = place[rule.other];
    (void)part.servos.linkages.try_push(rule);
  }
  for (const servo::Servo& one : part.servos.servos) (void)FindBus(all, one.bus.view());
  part.buses = all.buses;
  return WithServos(std::move(part));
}

WholeWay WholeWayOf(const app::ServoBusConfig& bus) {
  switch (bus.kind) {
    case app::BusKind::kMaestro:
    case app::BusKind::kReceiver:
      return kPulses;
    case app::BusKind::kDynamixel:
      return kTurn;
    case app::BusKind::kFeetech:
      return bus.series == bus::FeetechSeries::kSts ? kTurn : kScsTurn;
  }
  return kPulses;
}

const char* UnitOf(const app::ServoBusConfig& bus) {
  const bool pulses = bus.kind == app::BusKind::kMaestro || bus.kind == app::BusKind::kReceiver;
  return pulses ? "us" : "counts";
}

Installation Alone(const app::ServoBusConfig& bus, const servo::Servo& known) {
  const WholeWay way = WholeWayOf(bus);
  const float cautious = (way.high - way.low) / kSecondsForTheWholeWay;
  const bool limited = known.min < known.max;
  servo::Servo servo;
  servo.name = known.name;
  servo.bus = known.bus;
  servo.id = known.id;
  servo.min = way.low;
  servo.max = way.high;
  servo.neutral = limited ? known.neutral : (way.low + way.high) / 2;
  servo.max_speed_per_s = limited ? known.crawl_speed_per_s : cautious;
  servo.crawl_speed_per_s = servo.max_speed_per_s;
  servo.max_acceleration_per_s2 = servo.max_speed_per_s / kSecondsToFullSpeed;
  Installation alone{.rig_file = {}, .control = {}, .buses = {bus}, .servos = {}};
  (void)alone.servos.servos.try_push(servo);
  return alone;
}

}  // namespace facewire::tools
