#include "tools/facewire/rig/rig_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/rig/response.h"

namespace facewire::tools::rig {
namespace {

constexpr double kHeadTurnDeg = 60;
constexpr double kHeadMoveCm = 10;
// Less than this part of a range is worth a word: a soft knee alone takes a few percent.
constexpr double kFarEnough = 0.8;
// A full signal that asks for so many times the range is cut for most of its way.
constexpr double kTooFar = 1.5;

std::string Name(const Channel& channel) { return std::string(channel.name.view()); }

std::string Figure(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string Listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

bool Follows(const Channel& channel, const Rig& rig) {
  if (!IsPosition(channel.kind) || !channel.drives.empty()) return false;
  const facewire::Bone& bone = rig.bones[static_cast<std::size_t>(channel.bone)];
  return bone.landmark >= 0 || !bone.marker.empty();
}

// What a face shows, and what of a rig can show it.
struct Feature {
  const char* what;
  std::vector<std::string_view> signals;  // any that begins so drives a channel, ...
  std::vector<std::int16_t> landmarks;    // ... or a bone follows one of these
};

const std::vector<Feature>& Features() {
  // Landmarks: lids' edges, chin and lips, corners of the mouth, brows (app/rig_file.cc).
  static const std::vector<Feature> kFeatures = {
      {"a blink of the left eye", {"eyeBlinkLeft"}, {386}},
      {"a blink of the right eye", {"eyeBlinkRight"}, {159}},
      {"an open mouth", {"jawOpen"}, {152, 17, 14}},
      {"a smile", {"mouthSmile"}, {291, 61}},
      {"brows", {"brow"}, {336, 334, 300, 107, 105, 70}},
      {"where the eyes look", {"eyeLook"}, {473, 468}},
      {"how the head turns", {"head."}, {}},
  };
  return kFeatures;
}

class Checker {
 public:
  Checker(const Rig& rig, const servo::ServoRig& servos, std::span<const std::string> signals)
      : rig_(rig), servos_(servos), signals_(signals) {}

  std::vector<Remark> Check() {
    for (const Feature& feature : Features()) CheckFeature(feature);
    CheckDrives();
    CheckReach();
    CheckLimits();
    CheckSides();
    CheckBones();
    if (!servos_.servos.empty()) CheckServos();
    std::stable_partition(remarks_.begin(), remarks_.end(),
                          [](const Remark& remark) { return remark.lacks; });
    return std::move(remarks_);
  }

 private:
  void Lacks(std::string text) { remarks_.push_back({true, std::move(text)}); }
  void Hint(std::string text) { remarks_.push_back({false, std::move(text)}); }

  bool IsKnown(std::string_view signal) const {
    return signal.starts_with("head.") || std::ranges::find(signals_, signal) != signals_.end();
  }

  void CheckFeature(const Feature& feature) {
    for (const Channel& channel : rig_.channels) {
      for (const Drive& drive : channel.drives)
        for (const std::string_view signal : feature.signals)
          if (drive.signal.view().starts_with(signal) && drive.gain != 0) return;
      if (Follows(channel, rig_) &&
          std::ranges::count(feature.landmarks,
                             rig_.bones[static_cast<std::size_t>(channel.bone)].landmark) > 0)
        return;
    }
    const std::string_view signal = feature.signals[0];
    const bool more =
        signal == "mouthSmile" || signal == "eyeLook" || signal == "brow" || signal == "head.";
    Lacks(std::string(feature.what) + ": no channel is driven by " + std::string(signal) +
          (more ? "..." : "") +
          (feature.landmarks.empty() ? "" : ", and no bone follows a landmark there"));
  }

  void CheckDrives() {
    for (const Channel& channel : rig_.channels) {
      std::vector<std::string> unknown;
      for (const Drive& drive : channel.drives)
        if (!IsKnown(drive.signal.view())) unknown.emplace_back(drive.signal.view());
      if (!unknown.empty())
        Lacks(Name(channel) + ": the profile has no signal " + Listed(unknown) +
              "; facewired refuses the rig with this profile");
      if (channel.drives.empty() && !Follows(channel, rig_))
        Lacks(Name(channel) + ": never moves; it has neither a drive nor a landmark");
    }
  }

  void CheckReach() {
    for (const Channel& channel : rig_.channels) {
      if (channel.drives.empty()) continue;
      const Reach reach = ReachOf(channel);
      CheckEnd(channel, "max", reach.high - static_cast<double>(channel.neutral),
               static_cast<double>(channel.max) - static_cast<double>(channel.neutral));
      CheckEnd(channel, "min", static_cast<double>(channel.neutral) - reach.low,
               static_cast<double>(channel.neutral) - static_cast<double>(channel.min));
    }
  }

  // How far a channel gets towards one of its ends, and how far it could; both from neutral.
  void CheckEnd(const Channel& channel, const char* end, double reached, double range) {
    if (range <= 0 || (channel.kind != ChannelKind::kParameter && reached <= 0)) return;
    if (reached < kFarEnough * range) {
      // A little room behind neutral is a margin, and no mistake.
      const double whole = static_cast<double>(channel.max) - static_cast<double>(channel.min);
      if (reached <= 0 && range < 0.25 * whole) return;
      Hint(Name(channel) + ": never comes near its " + end + "; full signals take it " +
           Figure(std::max(reached, 0.0)) + " of " + Figure(range) + " that way");
    } else if (reached > kTooFar * range && !IsHeadDriven(channel)) {
      Hint(Name(channel) + ": is at its " + end + " with " +
           std::to_string(std::lround(100 * range / reached)) +
           " % of its signals, and stays there beyond; smaller gains or a curve use them all");
    }
  }

  static bool IsHeadDriven(const Channel& channel) {
    return std::ranges::any_of(channel.drives,
                               [](const Drive& d) { return d.signal.view().starts_with("head."); });
  }

  void CheckLimits() {
    std::vector<std::string> speeds, accelerations;
    for (const Channel& channel : rig_.channels) {
      if (channel.max_speed_per_s == 0) {
        speeds.push_back(Name(channel));
      } else if (channel.max_acceleration_per_s2 == 0 && channel.kind != ChannelKind::kParameter) {
        accelerations.push_back(Name(channel));
      }
    }
    if (!speeds.empty())
      Hint("no limit of speed (max_speed): " + Listed(speeds) +
           "; a lost and found face jumps with them");
    if (!accelerations.empty())
      Hint("no limit of acceleration (max_acceleration): " + Listed(accelerations) +
           "; a servo behind them gets jolts");
  }

  // One side that answers to what the other does not.
  void CheckSides() {
    for (const auto& [one, other] : {std::pair("Left", "Right"), std::pair("Right", "Left")}) {
      std::vector<std::string> alone;
      for (const std::string& signal : signals_) {
        if (!signal.ends_with(one) || signal == "jawLeft" || signal == "jawRight" ||
            signal == "mouthLeft" || signal == "mouthRight" || signal.starts_with("eyeBlink"))
          continue;
        const std::string twin =
            signal.substr(0, signal.size() - std::string_view(one).size()) + other;
        if (IsUsed(signal) && !IsUsed(twin)) alone.push_back(signal);
      }
      if (!alone.empty()) Hint("only one side answers: " + Listed(alone));
    }
  }

  bool IsUsed(std::string_view signal) const {
    return std::ranges::any_of(rig_.channels, [&](const Channel& channel) {
      return std::ranges::any_of(channel.drives,
                                 [&](const Drive& d) { return d.signal.view() == signal; });
    });
  }

  void CheckBones() {
    std::vector<std::string> still, markers;
    for (std::size_t i = 0; i < rig_.bones.size(); ++i) {
      const facewire::Bone& bone = rig_.bones[i];
      if (!bone.marker.empty()) markers.emplace_back(bone.name.view());
      if (std::ranges::none_of(rig_.channels,
                               [&](const Channel& c) { return c.bone == static_cast<int>(i); }))
        still.emplace_back(bone.name.view());
    }
    if (!still.empty()) Hint("bones without an axis, which never move: " + Listed(still));
    if (!markers.empty())
      Hint("bones that follow a marker move with recorded takes only, not live: " +
           Listed(markers));
  }

  void CheckServos() {
    std::vector<std::string> jolting, by_hand, unmoved;
    for (const servo::Servo& servo : servos_.servos) {
      const std::string name(servo.name.view());
      if (servo.max_acceleration_per_s2 == 0) jolting.push_back(name);
      if (servo.sources.empty()) {
        by_hand.push_back(name);
      } else {
        CheckMap(servo, name);
      }
    }
    for (const Channel& channel : rig_.channels)
      if (channel.kind != ChannelKind::kParameter &&
          std::ranges::none_of(servos_.servos, [&](const servo::Servo& servo) {
            return std::ranges::any_of(servo.sources, [&](const servo::Source& source) {
              return source.channel == channel.name;
            });
          }))
        unmoved.push_back(Name(channel));
    if (!jolting.empty())
      Hint("servos without a limit of acceleration (max_acceleration): " + Listed(jolting));
    if (!by_hand.empty()) Hint("servos that no channel moves (no from): " + Listed(by_hand));
    if (!unmoved.empty()) Hint("channels of bones that no servo shows: " + Listed(unmoved));
  }

  // The sum that the channels can make, against what the map has room for.
  void CheckMap(const servo::Servo& servo, const std::string& name) {
    double low = static_cast<double>(servo.offset);
    double high = low;
    for (const servo::Source& source : servo.sources) {
      const auto index = rig_.FindChannel(source.channel.view());
      if (!index) return;  // LoadServoRig reports it
      const double gain = static_cast<double>(source.gain);
      const double a = gain * static_cast<double>(rig_.channels[*index].min);
      const double b = gain * static_cast<double>(rig_.channels[*index].max);
      low += std::min(a, b);
      high += std::max(a, b);
    }
    const auto first = static_cast<double>(servo.map[0].in);
    const auto last = static_cast<double>(servo.map[servo.map.size() - 1].in);
    const double slack = 0.02 * (high - low);
    if (low < first - slack || high > last + slack)
      Hint("servo " + name + ": its map ends at " + Figure(first) + " and " + Figure(last) +
           ", its channels go from " + Figure(low) + " to " + Figure(high) +
           "; what is beyond is not seen");
    if (high - low < kFarEnough * (last - first))
      Hint("servo " + name + ": its channels go from " + Figure(low) + " to " + Figure(high) +
           " only, its map from " + Figure(first) + " to " + Figure(last));
  }

  const Rig& rig_;
  const servo::ServoRig& servos_;
  std::span<const std::string> signals_;
  std::vector<Remark> remarks_;
};

// What a signal can be.
Reach RangeOf(std::string_view signal) {
  if (!signal.starts_with("head.")) return {0, 1};
  const char axis = signal.back();
  const bool moves = signal.size() == 6 && axis >= 'x' && axis <= 'z';
  const double most = moves ? kHeadMoveCm : kHeadTurnDeg;
  return {-most, most};
}

}  // namespace

Reach ReachOf(const Channel& channel) {
  double low = 0;
  double high = 0;
  for (const Drive& drive : channel.drives) {
    const Reach range = RangeOf(drive.signal.view());
    const auto gain = static_cast<double>(drive.gain);
    low += std::min(gain * range.low, gain * range.high);
    high += std::max(gain * range.low, gain * range.high);
  }
  const double a = Respond(channel.response, low);
  const double b = Respond(channel.response, high);
  const auto neutral = static_cast<double>(channel.neutral);
  return {neutral + std::min(a, b), neutral + std::max(a, b)};
}

std::vector<Remark> CheckRig(const Rig& rig, const servo::ServoRig& servos,
                             std::span<const std::string> signals) {
  return Checker(rig, servos, signals).Check();
}

}  // namespace facewire::tools::rig
