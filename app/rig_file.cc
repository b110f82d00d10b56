#include "app/rig_file.h"

#include <algorithm>
#include <array>

#include "app/toml_reader.h"
#include "core/base/capacity.h"
#include "core/marker_name.h"

namespace facewire::app {
namespace {

struct NamedLandmark {
  std::string_view name;
  std::int16_t index;
};

// Indices of MediaPipe's face mesh; checked against the positions of the canonical face model
// (Apache-2.0).
constexpr std::array kLandmarks = {
    NamedLandmark{"forehead", 10},
    NamedLandmark{"glabella", 9},
    NamedLandmark{"nose_bridge", 168},
    NamedLandmark{"nose_tip", 1},
    NamedLandmark{"left_nostril", 327},
    NamedLandmark{"right_nostril", 98},
    NamedLandmark{"chin", 152},
    NamedLandmark{"left_jaw", 397},
    NamedLandmark{"right_jaw", 172},
    NamedLandmark{"left_cheek", 280},
    NamedLandmark{"right_cheek", 50},
    NamedLandmark{"upper_lip", 0},
    NamedLandmark{"lower_lip", 17},
    NamedLandmark{"upper_lip_inside", 13},
    NamedLandmark{"lower_lip_inside", 14},
    NamedLandmark{"left_mouth_corner", 291},
    NamedLandmark{"right_mouth_corner", 61},
    NamedLandmark{"left_eye_outer", 263},
    NamedLandmark{"left_eye_inner", 362},
    NamedLandmark{"right_eye_outer", 33},
    NamedLandmark{"right_eye_inner", 133},
    NamedLandmark{"left_upper_lid", 386},
    NamedLandmark{"left_lower_lid", 374},
    NamedLandmark{"right_upper_lid", 159},
    NamedLandmark{"right_lower_lid", 145},
    NamedLandmark{"left_brow_inner", 336},
    NamedLandmark{"left_brow_middle", 334},
    NamedLandmark{"left_brow_outer", 300},
    NamedLandmark{"right_brow_inner", 107},
    NamedLandmark{"right_brow_middle", 105},
    NamedLandmark{"right_brow_outer", 70},
    NamedLandmark{"left_iris", 473},
    NamedLandmark{"right_iris", 468},
};

constexpr std::array<std::string_view, 6> kHeadSignals = {"head.pitch", "head.yaw", "head.roll",
                                                          "head.x",     "head.y",   "head.z"};

struct Axis {
  std::string_view name;
  ChannelKind kind;
  NumberRange range;  // what any channel of this kind may have
};
constexpr std::array kAxes = {
    Axis{"x", ChannelKind::kPositionX, {-1000, 1000, "cm"}},
    Axis{"y", ChannelKind::kPositionY, {-1000, 1000, "cm"}},
    Axis{"z", ChannelKind::kPositionZ, {-1000, 1000, "cm"}},
    Axis{"pitch", ChannelKind::kPitch, {-180, 180, "degrees"}},
    Axis{"yaw", ChannelKind::kYaw, {-180, 180, "degrees"}},
    Axis{"roll", ChannelKind::kRoll, {-180, 180, "degrees"}},
};
constexpr NumberRange kParameterRange{-1e6, 1e6};
constexpr NumberRange kGainRange{-1e6, 1e6};
constexpr NumberRange kChannelGainRange{-1000, 1000};
constexpr NumberRange kKneeRange{0, 0.5};
constexpr NumberRange kRateRange{0, 1e9};

// The knee of a bone's axis that does not give one: wide enough to take the jolt out of a servo
// that runs to its end. A parameter has none: a blend shape driven to 1 must be at 1.
constexpr float kBoneKnee = 0.1F;

class RigReader {
 public:
  explicit RigReader(const std::vector<std::string>* known_signals) : check_(known_signals) {
    if (known_signals != nullptr) known_ = *known_signals;
    known_.insert(known_.end(), kHeadSignals.begin(), kHeadSignals.end());
  }

  Rig Read(TableReader& top) {
    if (top.Require("name", "what the character is called")) top.Name("name", rig_.name);
    top.EachTable("bone", [this](TableReader& bone) { ReadBone(bone); });
    top.EachTable("parameter", [this](TableReader& parameter) { ReadParameter(parameter); });
    if (rig_.channels.empty() && !top.Has("bone") && !top.Has("parameter")) {
      top.Require("parameter",
                  "a rig needs at least one [[bone]] with an axis, or one [[parameter]]");
    }
    for (const std::string_view key : {"servos", "servo", "linkage"}) top.Leave(key);
    top.Finish();
    return rig_;
  }

 private:
  void ReadBone(TableReader& table) {
    Bone bone;
    bool named = table.Require("name", "every bone has one") && table.Name("name", bone.name);
    if (named &&
        std::ranges::any_of(rig_.bones, [&](const Bone& b) { return b.name == bone.name; })) {
      table.Problem("name", "a second bone \"" + std::string(bone.name.view()) +
                                "\"; every name may be there once");
      named = false;
    }
    if (table.Has("landmark")) bone.landmark = ReadLandmark(table);
    if (table.Has("marker")) ReadMarker(table, bone);
    std::array<float, 3> rest{};
    table.Numbers("rest_cm", rest.data(), rest.size(), {-1000, 1000, "cm"});
    bone.rest_cm = {rest[0], rest[1], rest[2]};
    const auto index = static_cast<std::int16_t>(rig_.bones.size());
    if (!rig_.bones.try_push(bone)) {
      table.Problem("name", "too many bones; the most is " + std::to_string(kMaxBones));
    }
    for (const Axis& axis : kAxes) {
      TableReader limits = table.Table(axis.name);
      if (!table.Has(axis.name)) continue;
      Channel channel;
      channel.kind = axis.kind;
      channel.bone = index;
      channel.min = 0;
      channel.max = 0;
      channel.knee = kBoneKnee;
      const std::string name = std::string(bone.name.view()) + "." + std::string(axis.name);
      if (const auto made = ShortName::From(name)) {
        channel.name = *made;
      } else if (named) {
        table.Problem("name", "\"" + name + "\" is longer than " + std::to_string(kMaxNameLength) +
                                  " characters; shorten the bone's name");
        named = false;
      }
      const bool limited = limits.Require("min", "the lowest value (a position is an offset)") &
                           limits.Require("max", "the highest value (a position is an offset)");
      ReadChannel(limits, axis.range, channel);
      // A landmark that is wrong was reported; the bone was meant to have one.
      const bool follows = IsPosition(axis.kind) && (table.Has("landmark") || table.Has("marker"));
      if (limited && channel.drives.empty() && !limits.Has("drive") && !follows) {
        table.Problem(axis.name,
                      IsPosition(axis.kind)
                          ? "would never move; give the bone a landmark or a marker, or a "
                            "drive here"
                          : "would never move; give it a drive, as drive = { jawOpen = 20 }");
      }
      limits.Finish();
      if (named) Push(table, axis.name, channel);
    }
    table.Finish();
  }

  void ReadParameter(TableReader& table) {
    Channel channel;
    const bool named =
        table.Require("name", "every parameter has one") && table.Name("name", channel.name);
    if (named && !table.Has("drive"))
      AddDrive(table.Where("name"), table, channel.name.view(), 1, channel);
    ReadChannel(table, kParameterRange, channel);
    if (named) Push(table, "name", channel);
    table.Finish();
  }

  void ReadChannel(TableReader& table, const NumberRange& range, Channel& channel) {
    table.Number("min", channel.min, range);
    table.Number("max", channel.max, range);
    table.Number("neutral", channel.neutral, range);
    table.Number("max_speed", channel.max_speed_per_s, kRateRange);
    table.Number("max_acceleration", channel.max_acceleration_per_s2, kRateRange);
    if (channel.min >= channel.max) {
      table.Problem("min", Printed(channel.min) + " is not below max, " + Printed(channel.max));
    } else if (channel.neutral < channel.min || channel.neutral > channel.max) {
      table.Problem("neutral", Printed(channel.neutral) + " is outside min to max, " +
                                   Printed(channel.min) + " to " + Printed(channel.max));
    }
    table.EachNumber("drive",
                     [&](std::string_view signal, double gain, const toml::source_region& where) {
                       AddDrive(where, table, signal, static_cast<float>(gain), channel);
                     });
    ReadResponse(table, range, channel);
  }

  void ReadResponse(TableReader& table, const NumberRange& range, Channel& channel) {
    Response& response = channel.response;
    table.Number("gain", response.gain, kChannelGainRange);
    table.Number("bias", response.bias, range);
    const bool usable = ReadCurve(table, response);
    table.Number("knee", channel.knee, kKneeRange);
    const float at_rest = channel.neutral + static_cast<float>(Respond(response, 0));
    const bool neutral_is_inside = channel.min <= channel.neutral && channel.neutral <= channel.max;
    if (usable && neutral_is_inside && (at_rest < channel.min || at_rest > channel.max)) {
      table.Problem(table.Has("bias") ? "bias" : "curve",
                    "takes a neutral face to " + Printed(at_rest) + ", outside min to max, " +
                        Printed(channel.min) + " to " + Printed(channel.max));
    }
  }

  static bool ReadCurve(TableReader& table, Response& response) {
    bool rises = true;
    const auto problem = [&](const toml::source_region& where, const std::string& what) {
      if (rises) table.ProblemAt(where, "curve", what);
      rises = false;
    };
    const bool read = table.EachPair(
        "curve", kParameterRange, [&](float in, float out, const toml::source_region& where) {
          const CurvePoint* last =
              response.curve.empty() ? nullptr : &response.curve[response.curve.size() - 1];
          if (last != nullptr && in <= last->in) {
            problem(where, "the point at " + Printed(in) + " comes after the one at " +
                               Printed(last->in) + "; points go from left to right");
          } else if (last != nullptr && out < last->out) {
            problem(where, "falls from " + Printed(last->out) + " to " + Printed(out) +
                               "; a curve only rises, a negative gain turns the channel around");
          } else if (!response.curve.try_push({in, out})) {
            problem(where, "too many points; the most is " + std::to_string(kMaxCurvePoints));
          }
        });
    if (!read || !rises) return false;
    if (!table.Has("curve") || response.curve.size() >= 2) return true;
    table.Problem("curve", "needs two points at least, as [[0, 0], [1, 1]]");
    return false;
  }

  void AddDrive(const toml::source_region& where, TableReader& table, std::string_view signal,
                float gain, Channel& channel) {
    const auto name = ShortName::From(signal);
    if (!name || (check_ != nullptr && std::ranges::find(known_, signal) == known_.end())) {
      table.ProblemAt(where, "drive",
                      "no signal \"" + std::string(signal) + "\" in the profile, nor of the head" +
                          Suggestion(signal, known_));
    } else if (gain < kGainRange.min || gain > kGainRange.max) {
      table.ProblemAt(where, "drive", "a gain of " + Printed(gain) + " is out of range");
    } else if (!channel.drives.try_push({*name, gain})) {
      table.ProblemAt(where, "drive",
                      "too many signals; the most is " + std::to_string(kMaxDrives));
    }
  }

  void Push(TableReader& table, std::string_view key, const Channel& channel) {
    const std::string name(channel.name.view());
    if (rig_.FindChannel(name)) {
      table.Problem(key, "a second channel \"" + name + "\"; every name may be there once");
    } else if (!rig_.channels.try_push(channel)) {
      table.Problem(key, "too many channels; the most is " + std::to_string(kMaxChannels));
    }
  }

  // "lm33" is landmark 33 under the name that it has in marker files.
  static void ReadMarker(TableReader& table, Bone& bone) {
    ShortName name;
    const bool named = table.Name("marker", name);
    if (table.Has("landmark")) {
      table.Problem("marker", "the bone has a landmark too; give it one of them");
    } else if (const auto landmark = LandmarkOf(name.view())) {
      bone.landmark = *landmark;
    } else if (named) {
      bone.marker = name;
    }
  }

  static std::int16_t ReadLandmark(TableReader& table) {
    constexpr int kLast = static_cast<int>(kMaxLandmarks) - 1;
    if (!table.IsText("landmark")) {
      int index = -1;
      table.Integer("landmark", index, 0, kLast);
      return static_cast<std::int16_t>(index);
    }
    std::string name;
    table.Text("landmark", name);
    if (const auto index = LandmarkByName(name)) return *index;
    std::vector<std::string> names;
    names.reserve(kLandmarks.size());
    for (const NamedLandmark& known : kLandmarks) names.emplace_back(known.name);
    std::string hint = Suggestion(name, names);
    if (hint.empty())
      hint = "; expected 0 to " + std::to_string(kLast) + " or a name such as \"chin\"";
    table.Problem("landmark", "no landmark \"" + name + "\"" + hint);
    return -1;
  }

  Rig rig_;
  const std::vector<std::string>* check_;
  std::vector<std::string> known_;
};

}  // namespace

std::optional<std::int16_t> LandmarkByName(std::string_view name) {
  const auto* at = std::ranges::find(kLandmarks, name, &NamedLandmark::name);
  if (at == kLandmarks.end()) return std::nullopt;
  return at->index;
}

Rig LoadRig(const std::filesystem::path& file, const std::vector<std::string>* known_signals) {
  const toml::table root = ParseTomlFile(file);
  Problems problems(file.string());
  TableReader top(problems, &root, "");
  const Rig rig = RigReader(known_signals).Read(top);
  problems.ThrowIfAny();
  return rig;
}

}  // namespace facewire::app
