#include "app/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "app/toml_reader.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string Complaint(const std::string& text) {
  const Scratch scratch;
  const auto file = scratch.Write("facewire.toml", text);
  const std::string what = ProblemsOf([&] { (void)LoadConfig(file); });
  return Replaced(what, file.string(), "F");
}

struct Row {
  const char* text;
  const char* complaint;
};

TEST(LoadConfig, SaysWhatIsWrongWhereAndWhatWouldBeRight) {
  const Row table[] = {
      {"[camera]\nwidht_px = 640\n",
       "F:2:1: unknown key \"camera.widht_px\"; did you mean \"width_px\"?"},
      {"[kamera]\n", "F:1:2: unknown key \"kamera\"; did you mean \"camera\"?"},
      {"[camera]\nfps = \"thirty\"\n", "F:2:7: camera.fps: is a text; expected a whole number"},
      {"[camera]\nfps = 29.97\n", "F:2:7: camera.fps: is a number; expected a whole number"},
      {"[camera]\nfps = 0\n", "F:2:7: camera.fps: 0 is out of range; allowed: 1 to 240 Hz"},
      {"[camera]\nfps = 99999999999\n",
       "F:2:7: camera.fps: 1e+11 is out of range; allowed: 1 to 240 Hz"},
      {"[tracker]\nmin_presence = nan\n",
       "F:2:16: tracker.min_presence: nan is out of range; allowed: 0 to 1"},
      {"[tracker]\nmodel = \"atention\"\n",
       "F:2:9: tracker.model: \"atention\" is none of \"attention\", \"mesh\"; did you mean "
       "\"attention\"?"},
      {"camera = 3\n", "F:1:10: camera: is a number; expected a table"},
      {"[camera]\ndevice = \"usb\"\n",
       "F:2:10: camera.device: \"usb\" is not understood; expected \"v4l2:/dev/videoN\", "
       "\"libcamera:N\" or \"replay\""},
      {"[camera]\nformat = \"h264\"\n",
       "F:2:10: camera.format: \"h264\" is none of \"auto\", \"yuyv\", \"nv12\", "
       "\"i420\", \"rgb24\", \"bgr24\", \"mjpeg\", \"grey\""},
      {"[camera]\ndevice = \"replay\"\n",
       "F:2:10: camera.device: is \"replay\" but camera.replay.file names no video"},
      {"[camera.replay]\nloop = \"ping-pong\"\n",
       "F:2:8: camera.replay.loop: \"ping-pong\" plays backwards, too, from memory; set "
       "memory_mib"},
      {"[host]\nline = \"serial:\"\n",
       "F:2:8: host.line: \"serial:\" is not understood; expected \"serial:/dev/ttyACM0\", "
       "\"pty:LINK\" or \"none\""},
      {"[states]\nhold_ms = -1\n",
       "F:2:11: states.hold_ms: -1 is out of range; allowed: 0 to 600000 ms"},
      {"[states]\nneutral_frames = 0\n",
       "F:2:18: states.neutral_frames: 0 is out of range; allowed: 1 to 1000 frames"},
      {"[character]\nblend = 50\n", "F:2:9: character.blend: 50 is out of range; allowed: 0 to 1"},
      {"[filter.eyes]\nbeta = false\n",
       "F:2:8: filter.eyes.beta: is true or false; expected a number"},
      {"[host]\nprotocol = \"OSC\"\n",
       "F:2:12: host.protocol: \"OSC\" is none of \"native\", \"osc\"; did you mean \"osc\"?"},
      {"[host]\nmin_rate_hz = 5\n",
       "F:2:15: host.min_rate_hz: 5 is out of range; allowed: 20 to 240 Hz"},
  };
  for (const Row& row : table) EXPECT_EQ(Complaint(row.text), row.complaint) << row.text;
}

TEST(LoadConfig, RefusesAPathThatIsTooLongForASocket) {
  const std::string longest = "/" + std::string(106, 's');
  EXPECT_EQ(Complaint("[control]\nsocket = \"" + longest + "\"\n"), "");
  EXPECT_EQ(Complaint("[control]\nsocket = \"" + longest + "s\"\n"),
            "F:2:10: control.socket: the path " + longest +
                "s is too long for a socket; at most 107 characters");
}

TEST(LoadConfig, ReadsTheLinesOfAnExampleBoard) {
  const Scratch scratch;
  const GpioConfig gpio =
      LoadConfig(scratch.Write("f.toml",
                               "[gpio]\nchip = \"pinctrl-rp1\"\nstop_line = \"17\"\n"
                               "calibrate_line = \"GPIO27\"\ncalibrate_polarity = "
                               "\"active-high\"\ncalibrate_bias = \"pull-down\"\n"
                               "status_led_line = \"22\"\nservo_power_line = \"23\"\n"
                               "servo_power_polarity = \"active-low\"\n"))
          .gpio;
  EXPECT_EQ(gpio.chip, "pinctrl-rp1");
  EXPECT_EQ(gpio.stop.line, "17");
  EXPECT_TRUE(gpio.stop.active_low);
  EXPECT_EQ(gpio.stop.bias, hal::gpiod::Bias::kPullUp);
  EXPECT_EQ(gpio.calibrate.line, "GPIO27");
  EXPECT_FALSE(gpio.calibrate.active_low);
  EXPECT_EQ(gpio.calibrate.bias, hal::gpiod::Bias::kPullDown);
  EXPECT_FALSE(gpio.status_led.active_low);
  EXPECT_TRUE(gpio.servo_power.active_low);
}

TEST(LoadConfig, RefusesGpioLinesThatCannotBeMeant) {
  EXPECT_EQ(Complaint("[gpio]\nstop_line = \"17\"\nstatus_led_line = \"LED\"\n"),
            "F:2:13: gpio.stop_line: line 17 of which chip? Set gpio.chip; `facewire doctor` lists "
            "those there are");
  EXPECT_EQ(Complaint("[gpio]\nchip = \"c\"\nstop_line = \"1\"\nservo_power_line = \"1\"\n"),
            "F:4:20: gpio.servo_power_line: \"1\" is gpio.stop_line already; give each its own");
  EXPECT_EQ(Complaint("[gpio]\nstop_polarity = \"low\"\nstop_line = 17\n"),
            "F:2:17: gpio.stop_polarity: \"low\" is none of \"active-low\", \"active-high\"\n"
            "F:3:13: gpio.stop_line: is a number; expected a text");
}

// The most dangerous mistake: the stop seems to work, until its wire breaks.
TEST(LoadConfig, RefusesABiasThatWouldHideACutWire) {
  EXPECT_EQ(Complaint("[gpio]\nstop_bias = \"pull-down\"\n"),
            "F:2:13: gpio.stop_bias: would make a cut wire look like a contact that conducts; a "
            "contact that is active-low needs \"pull-up\"");
  EXPECT_EQ(Complaint("[gpio]\nstop_polarity = \"active-high\"\n"),
            "F:1:1: gpio.stop_bias: would make a cut wire look like a contact that conducts; a "
            "contact that is active-high needs \"pull-down\"");
  EXPECT_EQ(Complaint("[gpio]\nstop_polarity = \"active-high\"\nstop_bias = \"pull-down\"\n"), "");
  EXPECT_EQ(Complaint("[gpio]\nstop_polarity = \"active-high\"\nstop_bias = \"off\"\n"), "");
}

TEST(LoadConfig, ReportsEveryProblemAtOnceInTheOrderOfTheFile) {
  const std::string what =
      Complaint("[states]\nhold_ms = true\neaze_ms = 3\n[camera]\nfps = 1000\n[filter]\nx = 1\n");
  EXPECT_EQ(what,
            "F:2:11: states.hold_ms: is true or false; expected a whole number\n"
            "F:3:1: unknown key \"states.eaze_ms\"; did you mean \"ease_ms\"?\n"
            "F:5:7: camera.fps: 1000 is out of range; allowed: 1 to 240 Hz\n"
            "F:7:1: unknown key \"filter.x\"; known: eyes, mouth, rest");
}

TEST(LoadConfig, GivesThePlaceOfASyntaxError) {
  EXPECT_THAT(Complaint("[camera]\nfps = \n"), StartsWith("F:2:7: not valid TOML: "));
  EXPECT_THAT(Complaint("[camera]\nfps = 1\nfps = 2\n"), StartsWith("F:3:"));
}

TEST(LoadConfig, SaysWhenThereIsNoFile) {
  const Scratch scratch;
  EXPECT_THAT(ProblemsOf([&] { (void)LoadConfig(scratch / "none.toml"); }),
              HasSubstr("none.toml: cannot be read"));
  EXPECT_THAT(ProblemsOf([&] { (void)LoadConfig(scratch / ""); }), HasSubstr("is a folder"));
}

TEST(LoadConfig, ResolvesPathsAgainstTheFolderOfTheFile) {
  const Scratch scratch;
  const auto file = scratch.Write("f.toml",
                                  "[camera.replay]\nfile = \"a/../clip.mp4\"\n"
                                  "[host]\nline = \"pty:line\"\nprotocol = \"osc\"\n"
                                  "[tracker]\nnetworks = \"/n\"\n[character]\nprofile = \"\"\n");
  const Config config = LoadConfig(file);
  EXPECT_EQ(config.camera.replay.file, scratch / "clip.mp4");
  EXPECT_EQ(config.character.rig, scratch / "rig.toml") << "a default, too";
  EXPECT_EQ(config.host.line, "pty:" + (scratch / "line").string());
  EXPECT_EQ(config.host.protocol, HostProtocol::kOsc);
  EXPECT_EQ(config.tracker.networks, "/n");
  EXPECT_TRUE(config.character.profile.empty()) << "an empty path stays empty";
}

TEST(LoadConfig, AcceptsAnEmptyFile) {
  const Scratch scratch;
  const Config config = LoadConfig(scratch.Write("f.toml", ""));
  EXPECT_EQ(config.camera.fps, 30);
}

TEST(LoadConfig, TheFormatOfTheCameraIsFoundOrNamed) {
  const Scratch scratch;
  const auto format = [&](const std::string& name) {
    return LoadConfig(scratch.Write("f.toml", "[camera]\nformat = \"" + name + "\"\n"))
        .camera.format;
  };
  EXPECT_EQ(format("auto"), std::nullopt);
  for (const hal::CameraFormat each : hal::kEveryCameraFormat) {
    EXPECT_EQ(format(std::string(hal::Name(each))), each);
  }
}

// Two configurations are equal when the reader, asked for every key, makes the same of them.
TEST(ExampleConfig, ListsEveryKeyWithItsDefault) {
  const std::filesystem::path example =
      std::filesystem::path(FACEWIRE_SOURCE_DIR) / "app/share/facewire.toml";
  const Config read = LoadConfig(example);
  const Scratch scratch;
  const Config defaults = LoadConfig(scratch.Write("facewire.toml", ""));
  EXPECT_EQ(read.camera.device, defaults.camera.device);
  EXPECT_EQ(read.camera.width_px, defaults.camera.width_px);
  EXPECT_EQ(read.camera.height_px, defaults.camera.height_px);
  EXPECT_EQ(read.camera.fps, defaults.camera.fps);
  EXPECT_EQ(read.camera.format, defaults.camera.format);
  EXPECT_EQ(read.camera.replay.file, defaults.camera.replay.file);
  EXPECT_EQ(read.camera.replay.pace, defaults.camera.replay.pace);
  EXPECT_EQ(read.camera.replay.loop, defaults.camera.replay.loop);
  EXPECT_EQ(read.camera.replay.memory_mib, defaults.camera.replay.memory_mib);
  EXPECT_EQ(read.tracker.tracker.model, defaults.tracker.tracker.model);
  EXPECT_EQ(read.tracker.tracker.min_detection_score, defaults.tracker.tracker.min_detection_score);
  EXPECT_EQ(read.tracker.tracker.min_presence, defaults.tracker.tracker.min_presence);
  EXPECT_EQ(read.tracker.networks, defaults.tracker.networks);
  for (const auto group :
       {&filter::FilterConfig::eyes, &filter::FilterConfig::mouth, &filter::FilterConfig::rest}) {
    EXPECT_EQ((read.filter.*group).min_cutoff_hz, (defaults.filter.*group).min_cutoff_hz);
    EXPECT_EQ((read.filter.*group).beta, (defaults.filter.*group).beta);
    EXPECT_EQ((read.filter.*group).derivative_cutoff_hz,
              (defaults.filter.*group).derivative_cutoff_hz);
    EXPECT_EQ((read.filter.*group).speed_floor, (defaults.filter.*group).speed_floor);
  }
  EXPECT_EQ(read.pose.vertical_fov_deg, defaults.pose.vertical_fov_deg);
  EXPECT_EQ(read.character.rig.filename(), defaults.character.rig.filename());
  EXPECT_EQ(read.character.profile, defaults.character.profile);
  EXPECT_EQ(read.character.personal, defaults.character.personal);
  EXPECT_EQ(read.character.blend, defaults.character.blend);
  EXPECT_EQ(read.neutral.folder, defaults.neutral.folder);
  EXPECT_EQ(read.neutral.auto_s, defaults.neutral.auto_s);
  EXPECT_EQ(read.host.line, defaults.host.line);
  EXPECT_EQ(read.host.protocol, defaults.host.protocol);
  EXPECT_EQ(read.host.baud, defaults.host.baud);
  EXPECT_EQ(read.host.write_budget_ms, defaults.host.write_budget_ms);
  EXPECT_EQ(read.host.min_rate_hz, defaults.host.min_rate_hz);
  EXPECT_EQ(read.host.describe_every_s, defaults.host.describe_every_s);
  EXPECT_EQ(read.control.socket, defaults.control.socket);
  EXPECT_EQ(read.gpio.chip, defaults.gpio.chip);
  for (const auto line : {&GpioConfig::stop, &GpioConfig::calibrate, &GpioConfig::status_led,
                          &GpioConfig::servo_power}) {
    EXPECT_EQ((read.gpio.*line).line, (defaults.gpio.*line).line);
    EXPECT_EQ((read.gpio.*line).active_low, (defaults.gpio.*line).active_low);
    EXPECT_EQ((read.gpio.*line).bias, (defaults.gpio.*line).bias);
  }
  EXPECT_EQ(read.states.start_ramp, defaults.states.start_ramp);
  EXPECT_EQ(read.states.acquire, defaults.states.acquire);
  EXPECT_EQ(read.states.hold, defaults.states.hold);
  EXPECT_EQ(read.states.ease, defaults.states.ease);
  EXPECT_EQ(read.states.rest_after, defaults.states.rest_after);
  EXPECT_EQ(read.states.camera_timeout, defaults.states.camera_timeout);
  EXPECT_EQ(read.states.neutral_frames, defaults.states.neutral_frames);
}

// Every key that the reader knows stands in the example: the known keys are named by the complaint
// about one that resembles none.
TEST(ExampleConfig, OmitsNoKeyThatTheReaderKnows) {
  const toml::table example =
      ParseTomlFile(std::filesystem::path(FACEWIRE_SOURCE_DIR) / "app/share/facewire.toml");
  for (const char* path :
       {"", "camera", "camera.replay", "tracker", "filter", "filter.eyes", "filter.mouth",
        "filter.rest", "pose", "character", "neutral", "host", "control", "gpio", "states"}) {
    const std::string header = *path == 0 ? "" : "[" + std::string(path) + "]\n";
    const std::string what = Complaint(header + "qqqqqqqqqqqqqqqqqqqq = 1\n");
    const std::size_t known = what.find("known: ");
    ASSERT_NE(known, std::string::npos) << path << ": " << what;
    std::istringstream keys(what.substr(known + 7));
    for (std::string key; std::getline(keys >> std::ws, key, ',');) {
      if (key == "bus") continue;  // comments there: tests/app/animatronic/bus_tables_test.cc
      const std::string full = *path == 0 ? key : path + ("." + key);
      EXPECT_TRUE(example.at_path(full)) << full << " is not in the example";
    }
  }
}

}  // namespace
}  // namespace facewire::app
