#include "app/config.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/address_reader.h"
#include "app/animatronic/bus_tables.h"
#include "app/toml_reader.h"
#include "hal/gpiod/find_line.h"
#include "hal/local/local_socket.h"

namespace facewire::app {
namespace {

using Pace = ReplayConfig::Pace;
using Loop = ReplayConfig::Loop;

// A path of the file, made absolute. An empty one stays empty.
void ReadPath(TableReader& table, std::string_view key, const std::filesystem::path& folder,
              std::filesystem::path& value) {
  std::string text = value.string();
  table.Text(key, text);
  value = text.empty() ? std::filesystem::path{} : (folder / text).lexically_normal();
}

void ReadCamera(TableReader camera, const std::filesystem::path& folder, CameraConfig& config) {
  ReadAddress(camera, "device", R"("v4l2:/dev/videoN", "libcamera:N" or "replay")",
              {"v4l2:", "libcamera:", "replay"}, config.device);
  camera.Integer("width_px", config.width_px, 64, 4096, "px");
  camera.Integer("height_px", config.height_px, 64, 4096, "px");
  camera.Integer("fps", config.fps, 1, 240, "Hz");
  std::vector<std::pair<std::string_view, std::optional<hal::CameraFormat>>> formats = {
      {"auto", std::nullopt}};
  for (const hal::CameraFormat format : hal::kEveryCameraFormat) {
    formats.emplace_back(hal::Name(format), format);
  }
  camera.Choice("format", config.format, formats);
  TableReader replay = camera.Table("replay");
  ReadPath(replay, "file", folder, config.replay.file);
  replay.Choice<Pace>("pace", config.replay.pace,
                      {{"real-time", Pace::kRealTime}, {"fast", Pace::kFast}});
  replay.Choice<Loop>(
      "loop", config.replay.loop,
      {{"none", Loop::kNone}, {"restart", Loop::kRestart}, {"ping-pong", Loop::kPingPong}});
  replay.Integer("memory_mib", config.replay.memory_mib, 0, 65536, "MiB");
  if (config.replay.loop == Loop::kPingPong && config.replay.memory_mib == 0) {
    replay.Problem("loop", "\"ping-pong\" plays backwards, too, from memory; set memory_mib");
  }
  if (config.device == "replay" && config.replay.file.empty()) {
    camera.Problem("device", "is \"replay\" but camera.replay.file names no video");
  }
  replay.Finish();
  camera.Finish();
}

void ReadTracker(TableReader tracker, const std::filesystem::path& folder,
                 TrackerFilesConfig& config) {
  tracker.Choice<track::Model>(
      "model", config.tracker.model,
      {{"attention", track::Model::kAttention}, {"mesh", track::Model::kMesh}});
  ReadPath(tracker, "networks", folder, config.networks);
  tracker.Number("min_detection_score", config.tracker.min_detection_score, {0, 1});
  tracker.Number("min_presence", config.tracker.min_presence, {0, 1});
  tracker.Finish();
}

void ReadOneEuro(TableReader group, filter::OneEuroConfig& config) {
  group.Number("min_cutoff_hz", config.min_cutoff_hz, {0.001, 1000, "Hz"});
  group.Number("beta", config.beta, {0, 100000});
  group.Number("derivative_cutoff_hz", config.derivative_cutoff_hz, {0.001, 1000, "Hz"});
  group.Number("speed_floor", config.speed_floor, {0, 1000, "face sizes a second"});
  group.Finish();
}

void ReadFilter(TableReader filter, filter::FilterConfig& config) {
  ReadOneEuro(filter.Table("eyes"), config.eyes);
  ReadOneEuro(filter.Table("mouth"), config.mouth);
  ReadOneEuro(filter.Table("rest"), config.rest);
  filter.Finish();
}

void ReadHost(TableReader host, const std::filesystem::path& folder, HostConfig& config) {
  ReadLineAddress(host, "line", folder, true, config.line);
  host.Choice<HostProtocol>("protocol", config.protocol,
                            {{"native", HostProtocol::kNative}, {"osc", HostProtocol::kOsc}});
  host.Integer("baud", config.baud, 1200, 4'000'000, "baud");
  host.Integer("write_budget_ms", config.write_budget_ms, 0, 20, "ms");
  host.Integer("min_rate_hz", config.min_rate_hz, 20, 240, "Hz");
  host.Number("stuck_after_s", config.stuck_after_s, {0, 3600, "s"});
  host.Number("describe_every_s", config.describe_every_s, {0, 3600, "s"});
  host.Finish();
}

void ReadControl(TableReader control, const std::filesystem::path& folder, ControlConfig& config) {
  ReadPath(control, "socket", folder, config.socket);
  if (config.socket.native().size() > hal::local::kMaxPathLength) {
    control.Problem("socket", "the path " + config.socket.string() +
                                  " is too long for a socket; at most " +
                                  std::to_string(hal::local::kMaxPathLength) + " characters");
  }
  control.Finish();
}

using hal::gpiod::Bias;

// `key`_line and `key`_polarity; for a contact `key`_bias, too.
void ReadGpioLine(TableReader& gpio, const std::string& key, bool contact, const std::string& chip,
                  GpioLineConfig& config) {
  gpio.Text(key + "_line", config.line);
  gpio.Choice<bool>(key + "_polarity", config.active_low,
                    {{"active-low", true}, {"active-high", false}});
  if (!config.line.empty() && chip.empty() && hal::gpiod::OffsetOf(config.line)) {
    gpio.Problem(key + "_line", "line " + config.line +
                                    " of which chip? Set gpio.chip; `facewire doctor` lists those "
                                    "there are");
  }
  if (!contact) return;
  gpio.Choice<Bias>(key + "_bias", config.bias,
                    {{"pull-up", Bias::kPullUp},
                     {"pull-down", Bias::kPullDown},
                     {"off", Bias::kOff},
                     {"as-is", Bias::kAsIs}});
  // Pulled to the level at which the contact conducts, an open contact and a cut wire look closed.
  if (config.bias == (config.active_low ? Bias::kPullDown : Bias::kPullUp)) {
    gpio.Problem(key + "_bias", std::string("would make a cut wire look like a contact that ") +
                                    "conducts; a contact that is " +
                                    (config.active_low ? "active-low needs \"pull-up\""
                                                       : "active-high needs \"pull-down\""));
  }
}

void ReadGpio(TableReader gpio, GpioConfig& config) {
  gpio.Text("chip", config.chip);
  ReadGpioLine(gpio, "stop", true, config.chip, config.stop);
  ReadGpioLine(gpio, "calibrate", true, config.chip, config.calibrate);
  ReadGpioLine(gpio, "status_led", false, config.chip, config.status_led);
  ReadGpioLine(gpio, "servo_power", false, config.chip, config.servo_power);
  std::map<std::string, std::string> users;  // by line
  for (const auto& [key, line] : {std::pair("stop_line", &config.stop.line),
                                  {"calibrate_line", &config.calibrate.line},
                                  {"status_led_line", &config.status_led.line},
                                  {"servo_power_line", &config.servo_power.line}}) {
    if (line->empty()) continue;
    const auto [first, alone] = users.emplace(*line, key);
    if (alone) continue;
    gpio.Problem(key, "\"" + *line + "\" is gpio." + first->second + " already; give each its own");
  }
  gpio.Finish();
}

void ReadStates(TableReader states, state::StateConfig& config) {
  states.Milliseconds("start_ramp_ms", config.start_ramp, 60'000);
  states.Milliseconds("acquire_ms", config.acquire, 60'000);
  states.Milliseconds("hold_ms", config.hold, 600'000);
  states.Milliseconds("ease_ms", config.ease, 60'000);
  states.Milliseconds("rest_after_ms", config.rest_after, 86'400'000);
  states.Milliseconds("camera_timeout_ms", config.camera_timeout, 600'000);
  int frames = static_cast<int>(config.neutral_frames);
  states.Integer("neutral_frames", frames, 1, 1000, "frames");
  config.neutral_frames = static_cast<std::uint32_t>(frames);
  states.Finish();
}

}  // namespace

Config LoadConfig(const std::filesystem::path& file) {
  const toml::table root = ParseTomlFile(file);
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  Problems problems(file.string());
  TableReader top(problems, &root, "");
  Config config;
  ReadCamera(top.Table("camera"), folder, config.camera);
  ReadTracker(top.Table("tracker"), folder, config.tracker);
  ReadFilter(top.Table("filter"), config.filter);
  TableReader pose = top.Table("pose");
  pose.Number("vertical_fov_deg", config.pose.vertical_fov_deg, {10, 150, "degrees"});
  pose.Finish();
  TableReader character = top.Table("character");
  ReadPath(character, "rig", folder, config.character.rig);
  ReadPath(character, "profile", folder, config.character.profile);
  ReadPath(character, "personal", folder, config.character.personal);
  character.Number("blend", config.character.blend, {0, 1});
  character.Finish();
  TableReader neutral = top.Table("neutral");
  ReadPath(neutral, "folder", folder, config.neutral.folder);
  neutral.Number("auto_s", config.neutral.auto_s, {0, 60, "s"});
  neutral.Finish();
  ReadHost(top.Table("host"), folder, config.host);
  config.buses = ReadBuses(top, folder);
  ReadControl(top.Table("control"), folder, config.control);
  ReadGpio(top.Table("gpio"), config.gpio);
  ReadStates(top.Table("states"), config.states);
  top.Finish();
  problems.ThrowIfAny();
  return config;
}

}  // namespace facewire::app
