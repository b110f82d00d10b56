#include "app/servo_rig_file.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "app/error.h"
#include "app/toml_reader.h"
#include "core/base/capacity.h"

namespace facewire::app {
namespace {

using servo::Linkage;
using servo::Relation;
using servo::Servo;
using servo::ServoRig;

constexpr NumberRange kPositionRange{-1e5, 1e5};  // microseconds or counts
constexpr NumberRange kSumRange{-1e6, 1e6};
constexpr NumberRange kBandRange{0, 1e5};
constexpr NumberRange kRateRange{0, 1e9};
constexpr NumberRange kRuleGainRange{-1000, 1000};
constexpr int kLargestId = 253;  // a Dynamixel's is 252, a Feetech's 253
constexpr int kDayS = 24 * 60 * 60;
constexpr int kMinuteMs = 60'000;

// Of a servo that does not say: what a tracker's noise and most hobby servos stay within, and a
// crawl that takes ten times as long.
constexpr float kUsualDeadBand = 0.005F;  // part of min to max
constexpr float kUsualCrawl = 0.1F;       // part of the speed

std::string Quoted(const ShortName& name) { return "\"" + std::string(name.view()) + "\""; }

class ServoReader {
 public:
  explicit ServoReader(const Rig& rig) : rig_(rig) {
    for (const Channel& channel : rig.channels) channels_.emplace_back(channel.name.view());
  }

  ServoRig Read(TableReader& top) {
    for (const std::string_view key : {"name", "bone", "parameter"}) top.Leave(key);
    TableReader all = top.Table("servos");
    ReadAll(all);
    top.EachTable("servo", [this](TableReader& table) { ReadServo(table); });
    top.EachTable("linkage", [this](TableReader& table) { ReadLinkage(table); });
    return servos_;  // unknown keys beside these are LoadRig's to report
  }

 private:
  void ReadAll(TableReader& table) {
    servo::Contract& contract = servos_.contract;
    table.Milliseconds("fresh_ms", contract.fresh, kMinuteMs);
    table.Milliseconds("hold_ms", contract.hold, kMinuteMs);
    table.Milliseconds("ease_ms", contract.ease, kMinuteMs);
    table.Milliseconds("limp_ms", contract.limp, kDayS * 1000);
    table.Milliseconds("stop_torque_ms", contract.stop_torque, kDayS * 1000);
    table.Number("calm", servos_.following.calm, {0, 100, "dead bands"});
    table.Milliseconds("lead_ms", servos_.following.lead, 100);
    table.Finish();
  }

  void ReadServo(TableReader& table) {
    Servo servo;
    const bool named =
        table.Require("name", "every servo has one") && table.Name("name", servo.name);
    ReadAddress(table, servo);
    ReadSources(table, servo);
    const bool ranged = ReadMap(table, servo) && ReadRange(table, servo);
    ReadBands(table, servo);
    ReadMotion(table, servo);
    table.Finish();
    if (named && servos_.Find(servo.name.view())) {
      table.Problem("name",
                    "a second servo " + Quoted(servo.name) + "; every name may be there once");
    } else if (!servos_.servos.try_push(servo)) {
      table.Problem("name", "too many servos; the most is " + std::to_string(kMaxServos));
    } else {
      ranged_.push_back(ranged);
    }
  }

  void ReadAddress(TableReader& table, Servo& servo) {
    const bool bus = table.Require("bus", "the name of a [[bus]] of facewire.toml") &&
                     table.Name("bus", servo.bus);
    const bool given =
        table.Require("id", "the controller's channel, or the servo's id on its bus");
    int id = 0;
    table.Integer("id", id, 0, kLargestId);
    servo.id = static_cast<std::uint8_t>(id);
    if (!bus || !given) return;
    for (const Servo& other : servos_.servos) {
      if (other.bus != servo.bus || other.id != servo.id) continue;
      table.Problem("id", std::to_string(id) + " of bus " + Quoted(servo.bus) + " is " +
                              Quoted(other.name) + " already; every servo has an id of its own");
    }
  }

  void ReadSources(TableReader& table, Servo& servo) {
    table.EachNumber(
        "from", [&](std::string_view channel, double gain, const toml::source_region& where) {
          const auto name = ShortName::From(channel);
          if (!name || !rig_.FindChannel(channel)) {
            table.ProblemAt(where, "from",
                            "no channel \"" + std::string(channel) + "\" in this rig" +
                                Suggestion(channel, channels_));
          } else if (gain < kSumRange.min || gain > kSumRange.max) {
            table.ProblemAt(where, "from", "a gain of " + Printed(gain) + " is out of range");
          } else if (!servo.sources.try_push({*name, static_cast<float>(gain)})) {
            table.ProblemAt(where, "from",
                            "too many channels; the most is " + std::to_string(kMaxDrives));
          }
        });
    table.Number("offset", servo.offset, kSumRange);
  }

  // False when there is none to go by.
  static bool ReadMap(TableReader& table, Servo& servo) {
    if (!table.Has("map")) return !table.Has("from") || (table.Require("map", kMapIs), false);
    bool good = true;
    const auto problem = [&](const toml::source_region& where, const std::string& what) {
      if (good) table.ProblemAt(where, "map", what);
      good = false;
    };
    const bool read = table.EachPair(
        "map", kSumRange, [&](float in, float out, const toml::source_region& where) {
          const auto points = servo.map.span();
          if (out < kPositionRange.min || out > kPositionRange.max) {
            problem(where,
                    Printed(out) +
                        " is no position of a servo; expected microseconds, as 1500, or counts");
          } else if (!points.empty() && in <= points.back().in) {
            problem(where, "the point at " + Printed(in) + " comes after the one at " +
                               Printed(points.back().in) + "; points go from left to right");
          } else if (points.size() >= 2 && Turns(points, out)) {
            problem(where, "turns around at " + Printed(points.back().out) +
                               "; positions rise all the way or fall all the way");
          } else if (!servo.map.try_push({in, out})) {
            problem(where, "too many points; the most is " + std::to_string(kMaxCurvePoints));
          }
        });
    if (read && good && servo.map.size() < 2)
      problem(table.Where("map"), "needs two points at least, as [[0, 1000], [1, 2000]]");
    return read && good;
  }
  static bool Turns(std::span<const CurvePoint> points, float out) {
    const float way = points.back().out - points.front().out;
    return (out - points.back().out) * way < 0;
  }

  bool ReadRange(TableReader& table, Servo& servo) {
    const bool mapped = !servo.map.empty();
    if (mapped) {
      std::tie(servo.min, servo.max) =
          std::minmax({servo.map[0].out, servo.map[servo.map.size() - 1].out});
    } else if (!(table.Require("min", "the lowest position, in microseconds or counts") &
                 table.Require("max", "the highest position, in microseconds or counts"))) {
      return false;
    }
    table.Number("min", servo.min, kPositionRange);
    table.Number("max", servo.max, kPositionRange);
    if (servo.min >= servo.max) {
      if (table.Has("min") || table.Has("max")) {
        table.Problem(table.Has("min") ? "min" : "max",
                      "min, " + Printed(servo.min) + ", is not below max, " + Printed(servo.max));
      } else {
        table.Problem("map",
                      "stays at " + Printed(servo.min) + "; expected two positions at least");
      }
      return false;
    }
    servo.neutral = std::clamp(NeutralOf(servo), servo.min, servo.max);
    table.Number("neutral", servo.neutral, kPositionRange);
    if (servo.neutral >= servo.min && servo.neutral <= servo.max) return true;
    table.Problem("neutral", Printed(servo.neutral) + " is outside min to max, " +
                                 Printed(servo.min) + " to " + Printed(servo.max));
    return false;
  }
  // Where the rig's neutral pose has it; of a servo that no channel moves, the middle.
  float NeutralOf(const Servo& servo) const {
    if (servo.map.empty()) return (servo.min + servo.max) / 2;
    double sum = 0;
    for (const servo::Source& source : servo.sources) {
      const auto channel = rig_.FindChannel(source.channel.view());
      sum += double{source.gain} * rig_.channels[*channel].neutral;
    }
    return static_cast<float>(servo.PositionOf(sum));
  }

  static void ReadBands(TableReader& table, Servo& servo) {
    servo.dead_band = kUsualDeadBand * (servo.max - servo.min);
    for (const auto& [key, band] :
         {std::pair("dead_band", &servo.dead_band), std::pair("backlash", &servo.backlash)}) {
      table.Number(key, *band, kBandRange);
      if (servo.max > servo.min && *band > servo.max - servo.min) {
        table.Problem(key, Printed(*band) + " is wider than min to max");
      }
    }
  }

  static void ReadMotion(TableReader& table, Servo& servo) {
    const bool limited = table.Require(
        "max_speed", "in microseconds or counts a second; no servo is without a limit");
    table.Number("max_speed", servo.max_speed_per_s, kRateRange);
    table.Number("max_acceleration", servo.max_acceleration_per_s2, kRateRange);
    if (limited && servo.max_speed_per_s <= 0) {
      table.Problem("max_speed", "must be above 0");
    }
    servo.crawl_speed_per_s = kUsualCrawl * servo.max_speed_per_s;
    table.Number("crawl_speed", servo.crawl_speed_per_s, kRateRange);
    if (table.Has("crawl_speed") && limited &&
        (servo.crawl_speed_per_s <= 0 || servo.crawl_speed_per_s > servo.max_speed_per_s)) {
      table.Problem("crawl_speed", Printed(servo.crawl_speed_per_s) +
                                       " is not above 0 and at most max_speed, " +
                                       Printed(servo.max_speed_per_s));
    }
    int limp_after_s = 0;
    table.Integer("limp_after_s", limp_after_s, 0, kDayS, "s");
    servo.limp_after = std::chrono::seconds(limp_after_s);
  }

  std::optional<std::uint8_t> ReadServoName(TableReader& table, std::string_view key,
                                            std::string_view what) {
    ShortName name;
    if (!table.Require(key, what) || !table.Name(key, name)) return std::nullopt;
    if (const auto at = servos_.Find(name.view())) return static_cast<std::uint8_t>(*at);
    std::vector<std::string> names;
    for (const Servo& servo : servos_.servos) names.emplace_back(servo.name.view());
    table.Problem(key,
                  "no servo " + Quoted(name) + " in this rig" + Suggestion(name.view(), names));
    return std::nullopt;
  }

  void ReadLinkage(TableReader& table) {
    Linkage linkage;
    if (table.Require("name", "every rule has one")) table.Name("name", linkage.name);
    const auto yields = ReadServoName(table, "yields", "the servo that makes way");
    const auto other = ReadServoName(table, "other", "the servo that it must not meet");
    const bool related = table.Require("relation", "\"at_least\" or \"at_most\"");
    table.Choice<Relation>("relation", linkage.relation,
                           {{"at_least", Relation::kAtLeast}, {"at_most", Relation::kAtMost}});
    table.Number("gain", linkage.gain, kRuleGainRange);
    table.Number("offset", linkage.offset, kSumRange);
    table.Finish();
    if (!servos_.linkages.try_push(linkage)) {
      table.Problem("name", "too many rules; the most is " + std::to_string(kMaxLinkages));
      return;
    }
    if (!yields || !other) return;
    Linkage& kept = servos_.linkages[servos_.linkages.size() - 1];
    kept.yields = *yields;
    kept.other = *other;
    if (*yields == *other) {
      table.Problem("other", "is the servo that yields; a rule is between two");
    } else if (related && ranged_[*yields] && ranged_[*other]) {
      CheckAtNeutral(table, kept);
    }
  }

  void CheckAtNeutral(TableReader& table, const Linkage& linkage) {
    const float bound = linkage.gain * servos_.servos[linkage.other].neutral + linkage.offset;
    const float at = servos_.servos[linkage.yields].neutral;
    const bool at_least = linkage.relation == Relation::kAtLeast;
    if (at_least ? at >= bound : at <= bound) return;
    table.Problem("relation",
                  "is broken at neutral: " + Quoted(servos_.servos[linkage.yields].name) +
                      " rests at " + Printed(at) + " and must be at " +
                      (at_least ? "least " : "most ") + Printed(bound));
  }

  static constexpr std::string_view kMapIs = "from the sum to positions, as [[0, 1000], [1, 2000]]";
  const Rig& rig_;
  std::vector<std::string> channels_;
  ServoRig servos_;
  std::vector<bool> ranged_;  // of each servo: min, max and neutral are good
};

}  // namespace

ServoRig LoadServoRig(const std::filesystem::path& file, const Rig& rig) {
  const toml::table root = ParseTomlFile(file);
  Problems problems(file.string());
  TableReader top(problems, &root, "");
  ServoRig servos = ServoReader(rig).Read(top);
  problems.ThrowIfAny();
  if (servo::FindFlaw(servos, rig)) throw Failure(file.string() + ": the servos' checks disagree");
  return servos;
}

}  // namespace facewire::app
