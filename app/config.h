#ifndef FACEWIRE_APP_CONFIG_H_
#define FACEWIRE_APP_CONFIG_H_

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "app/host_protocol.h"
#include "core/base/time.h"
#include "core/filter/landmark_filter.h"
#include "core/pose/pose_estimator.h"
#include "core/state/state_machine.h"
#include "core/track/tracker.h"
#include "hal/camera_format.h"
#include "hal/gpiod/library.h"

// facewire.toml as plain structs. The defaults here are the defaults of the file;
// app/share/facewire.toml lists every key with them. Paths are absolute after LoadConfig.
namespace facewire::app {

struct ReplayConfig {
  enum class Pace : std::uint8_t { kRealTime, kFast };
  enum class Loop : std::uint8_t { kNone, kRestart, kPingPong };
  std::filesystem::path file;   // a video; empty = none
  Pace pace = Pace::kRealTime;  // kFast: every frame, as quickly as they can be processed
  Loop loop = Loop::kNone;      // kPingPong (no cut) needs memory_mib
  int memory_mib = 0;  // 0: streamed from the file; else decoded ahead into a block of that size
};

struct CameraConfig {
  std::string device = "v4l2:/dev/video0";  // "v4l2:PATH", "libcamera:N" or "replay"
  int width_px = 640;
  int height_px = 480;
  int fps = 30;
  // In what form it sends its pictures; nullopt: whichever reaches size and rate at the least cost.
  std::optional<hal::CameraFormat> format;
  ReplayConfig replay;
};

struct TrackerFilesConfig {
  track::TrackerConfig tracker;
  std::filesystem::path networks = "/usr/share/facewire/networks";  // folder of the .tflite files
};

struct CharacterConfig {
  std::filesystem::path rig = "rig.toml";
  std::filesystem::path profile = "/usr/share/facewire/average.profile";  // empty: bones only
  std::filesystem::path personal;  // a profile of the performer's own poses; empty: none
  float blend = 1;                 // how much it counts at start, 0 to 1
};

struct NeutralConfig {
  std::filesystem::path folder = "/var/lib/facewire";
  // Without a stored neutral, the first so many seconds of a steadily tracked face become a
  // provisional one. 0: wait for a calibrate command.
  float auto_s = 2;
};

struct HostConfig {
  std::string line =
      "serial:/dev/ttyACM0";  // "serial:PATH", "pty:LINK" (the link is made) or "none"
  HostProtocol protocol = HostProtocol::kNative;
  int baud = 115200;        // of a serial line; OSC never says more than that carries
  int write_budget_ms = 5;  // a tick waits so long at most for the line to take bytes
  int min_rate_hz = 20;     // poses a second even when the camera is silent
  // An open line that takes nothing for so long is stuck, which the watchdog ends by a restart. 0:
  // never (a host that may be off, at a USB gadget's other end).
  float stuck_after_s = 10;
  float describe_every_s =
      5;  // the rig's description again, for hosts that join later; 0 = on request
};

struct ControlConfig {
  // A local socket on which the board's own programs give commands; empty: none.
  std::filesystem::path socket = "/run/facewire/control";
};

struct GpioLineConfig {
  std::string line;         // an offset on the chip, or the line's name; empty: none
  bool active_low = false;  // a contact conducts, an LED is lit, servos have power at the low level
  hal::gpiod::Bias bias = hal::gpiod::Bias::kAsIs;  // of an input
};

struct GpioConfig {
  std::string chip;  // label, name or path; empty: every line has a name of its own
  GpioLineConfig stop{.line = "", .active_low = true, .bias = hal::gpiod::Bias::kPullUp};
  GpioLineConfig calibrate{.line = "", .active_low = true, .bias = hal::gpiod::Bias::kPullUp};
  GpioLineConfig status_led;
  GpioLineConfig servo_power;
};

struct Config {
  CameraConfig camera;
  TrackerFilesConfig tracker;
  filter::FilterConfig filter;
  pose::PoseConfig pose;
  CharacterConfig character;
  NeutralConfig neutral;
  HostConfig host;
  std::vector<ServoBusConfig> buses;
  ControlConfig control;
  GpioConfig gpio;
  state::StateConfig states;
};

// Reads the file. Throws BadInput with every problem on a line of its own:
// "FILE:LINE:COLUMN: what is wrong; what would be right". Paths in the file are relative to its
// folder.
Config LoadConfig(const std::filesystem::path& file);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CONFIG_H_
