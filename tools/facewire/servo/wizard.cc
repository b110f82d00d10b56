// facewire servo wizard: from bare servos to a configuration that drives them.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "app/config.h"
#include "app/devices.h"
#include "app/error.h"
#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "app/toml_reader.h"
#include "hal/system_clock.h"
#include "tools/facewire/full_screen.h"
#include "tools/facewire/output_file.h"
#include "tools/facewire/servo/ask.h"
#include "tools/facewire/servo/eeprom.h"
#include "tools/facewire/servo/open.h"
#include "tools/facewire/servo/rig_text.h"
#include "tools/facewire/servo/search.h"
#include "tools/facewire/servo/setting_value.h"
#include "tools/facewire/servo/verbs.h"
#include "tools/facewire/servo/wizard_text.h"
#include "tools/facewire/stop_flag.h"

namespace facewire::tools {
namespace {

namespace fs = std::filesystem;

struct WizardOptions {
  std::vector<std::string> ports;
  std::vector<std::string> kinds;
  std::string out;
  std::string config;
  std::string rig;
};

constexpr std::chrono::seconds kLongestSearch(4);
// Of the whole way, a second: quick for a face, and less than most servos can.
constexpr float kUsualSpeed = 1.5F;
constexpr float kWiggle = 1.0F / 40;  // of the whole way, to either side

std::string ReadFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Of what is installed, or else of the sources.
fs::path Share() {
  const fs::path installed = FACEWIRE_INSTALLED_SHARE;
  return fs::exists(installed / "otto.toml") ? installed : fs::path(FACEWIRE_SOURCE_SHARE);
}

std::string Answer(const std::string& question) {
  const auto line = AskLine(question);
  if (!line) throw app::Failure("the answers ended; nothing was written");
  return *line;
}

class Wizard {
 public:
  explicit Wizard(const WizardOptions& options) : options_(options) {
    options.config.empty() ? Begin() : Extend();
    rig_ = app::LoadRig(base_rig_);
    rig_text_ = ReadFile(base_rig_);
    servos_ = app::LoadServoRig(base_rig_, rig_);
    for (const servo::Servo& servo : servos_.servos) names_.emplace_back(servo.name.view());
  }

  void Run() {
    std::printf(
        "Servos must have power, and room to move: they will move slowly, one at a time.\n");
    for (const std::string& port : Ports()) SearchAndShow(port);
    if (shown_ == 0) throw app::Failure("no servo was shown; nothing was written");
    Write();
  }

 private:
  // A new folder's files.
  void Begin() {
    config_file_ = fs::path(options_.out) / "facewire.toml";
    rig_file_ = fs::path(options_.out) / "rig.toml";
    for (const fs::path& file : {config_file_, rig_file_}) {
      if (fs::exists(file)) {
        throw app::BadInput(file.string() + " exists; --config " + config_file_.string() +
                            " adds to it");
      }
    }
    const fs::path share = Share();
    base_rig_ = options_.rig.empty() ? share / "otto.toml" : fs::path(options_.rig);
    config_text_ =
        "# Made by facewire servo wizard. Everything else has its default: man facewire.toml.\n"
        "\n[character]\nrig = \"rig.toml\"\n";
    if (share != fs::path(FACEWIRE_INSTALLED_SHARE)) {
      config_text_ += "profile = \"" + (share / "average.profile").string() + "\"\n";
    }
  }
  void Extend() {
    config_file_ = options_.config;
    const app::Config config = app::LoadConfig(config_file_);
    rig_file_ = base_rig_ = config.character.rig;
    config_text_ = ReadFile(config_file_);
    buses_ = config.buses;
    RequireWritable(config_file_);
    RequireWritable(rig_file_);
  }

  std::vector<std::string> Ports() const {
    std::vector<std::string> ports = options_.ports.empty() ? SerialPorts() : options_.ports;
    if (ports.empty()) throw app::Failure("no serial port is there; plug the servos' adapter in");
    return ports;
  }

  void SearchAndShow(const std::string& port) {
    const auto search = [&] {
      SearchPlan plan;
      if (!options_.kinds.empty()) {
        std::erase_if(plan.protocols, [&](Protocol protocol) {
          return std::ranges::find(options_.kinds, KindOf(protocol)) == options_.kinds.end();
        });
      }
      std::printf("Searching %s ...\n", port.c_str());
      std::fflush(stdout);
      return SearchPort(
          port, [&](int baud) { return app::MakeSerialPort(port, baud); }, clock_, plan,
          [](const std::string&) {});
    };
    PortSearch found;
    try {
      found = search();
      if (found.buses.empty()) {
        std::printf("%s: no servos\n", port.c_str());
        return;
      }
      std::printf("\n%s", Describe(found.buses.front()).c_str());
      if (!found.buses.front().servos.empty() && GaveIds(found.buses.front())) {
        found = search();
        for (const FoundBus& bus : found.buses) std::printf("\n%s", Describe(bus).c_str());
      }
    } catch (const app::BadInput& error) {
      if (options_.ports.size() == 1) throw app::BadInput(WithService(error.what()));
      std::printf("%s\n", WithService(error.what()).c_str());
      return;
    }
    if (found.buses.empty()) throw app::Failure(port + ": the servos do not answer any more");
    if (found.buses.size() > 1) {
      std::printf(
          "Servos of this chain have different rates: those at %d baud are used;\n"
          "`facewire servo set BUS/ID baud %d --baud RATE` brings the others to it.\n",
          found.buses.front().baud, found.buses.front().baud);
    }
    ShowBus(found.buses.front());
  }

  // New servos all have id 1. Whether any got another one.
  bool GaveIds(const FoundBus& bus) {
    if (AskYes("Is every servo of this chain there, with an id of its own?", true)) return false;
    bool gave = false;
    for (;;) {
      const std::string id = Answer(
          "Connect one servo alone that still needs an id, and type the id; Enter when all have "
          "one: ");
      if (id.empty()) break;
      GiveId(bus, id);
      gave = true;
    }
    Answer("Connect all of them and press Enter: ");
    return gave;
  }
  void GiveId(const FoundBus& bus, const std::string& id) {
    SearchPlan plan;
    plan.protocols = {bus.protocol};
    plan.rates = {bus.baud};
    const auto alone = SearchPort(
        bus.port, [&](int baud) { return app::MakeSerialPort(bus.port, baud); }, clock_, plan,
        [](const std::string&) {});
    if (alone.buses.size() != 1 || alone.buses[0].servos.size() != 1) {
      std::printf("There is not exactly one servo; nothing was changed.\n");
      return;
    }
    Eeprom servo(
        ConfigOf(bus, "bus"), alone.buses[0].servos[0].id,
        [](const app::ServoBusConfig& at) { return app::MakeHostLine(at.port, at.baud); }, clock_);
    try {
      servo.Open();
      servo.Set("id", id);
      std::printf("It has id %s now.\n", id.c_str());
    } catch (const app::BadInput& error) {
      std::printf("%s\n", error.what());
    }
  }

  static app::ServoBusConfig ConfigOf(const FoundBus& found, const std::string& name) {
    app::ServoBusConfig bus;
    bus.name = name;
    switch (found.protocol) {
      case Protocol::kReceiver:
        bus.kind = app::BusKind::kReceiver;
        break;
      case Protocol::kMaestro:
        bus.kind = app::BusKind::kMaestro;
        break;
      case Protocol::kDynamixel:
        bus.kind = app::BusKind::kDynamixel;
        break;
      case Protocol::kFeetech:
        bus.kind = app::BusKind::kFeetech;
        break;
    }
    bus.port = "serial:" + found.port;
    bus.baud = found.baud;
    bus.rate_hz = app::DefaultRate(bus.kind);
    bus.maestro.crc = found.crc;
    if (found.scs) bus.series = bus::FeetechSeries::kScs;
    return bus;
  }

  void ShowBus(const FoundBus& found) {
    const app::ServoBusConfig* known = KnownBus(found.port);
    const std::string name = known != nullptr ? known->name : BusName();
    const app::ServoBusConfig bus = known != nullptr ? *known : ConfigOf(found, name);
    std::vector<std::uint8_t> ids;
    for (const FoundServo& servo : found.servos) ids.push_back(servo.id);
    if (ids.empty()) ids = Channels();
    std::printf("\nWhat may move a servo:\n%s\n", ChannelTable(rig_).c_str());
    bool any = false;
    for (const std::uint8_t id : ids) any = ShowServo(bus, id) || any;
    if (any && known == nullptr) {
      config_text_ += (config_text_.ends_with('\n') ? "\n" : "\n\n") + BusBlock(found, name);
      buses_.push_back(bus);
    }
  }
  const app::ServoBusConfig* KnownBus(const std::string& port) const {
    for (const app::ServoBusConfig& bus : buses_) {
      std::error_code ignored;
      const std::string path = bus.port.substr(bus.port.find(':') + 1);
      if (path == port || fs::equivalent(path, port, ignored)) return &bus;
    }
    return nullptr;
  }
  std::string BusName() const {
    for (;;) {
      std::string name = Answer("A name for this bus [head]: ");
      if (name.empty()) name = "head";
      const bool taken =
          std::ranges::find(buses_, name, &app::ServoBusConfig::name) != buses_.end();
      if (!taken && ShortName::From(name)) return name;
      std::printf("%s\n", taken ? "That is another bus already." : "Up to 31 letters, no spaces.");
    }
  }
  static std::vector<std::uint8_t> Channels() {
    for (;;) {
      std::istringstream words(Answer("On which channels are servos, as in 0 1 5? "));
      std::vector<std::uint8_t> channels;
      std::string word;
      bool good = true;
      while (words >> word) {
        const auto number = WholeNumber(word);
        good = good && number && *number >= 0 && *number < 24;
        if (good) channels.push_back(static_cast<std::uint8_t>(*number));
      }
      if (good) return channels;
      std::printf("Numbers from 0 to 23, with spaces between them.\n");
    }
  }

  // Whether it is one of the rig's now.
  bool ShowServo(const app::ServoBusConfig& bus, std::uint8_t id) {
    for (const servo::Servo& servo : servos_.servos) {
      if (servo.bus.view() != bus.name || servo.id != id) continue;
      std::printf("Servo %d is %s already.\n", id, std::string(servo.name.view()).c_str());
      return false;
    }
    for (;;) {
      const std::string word =
          Answer("Servo " + std::to_string(id) + " of " + bus.name +
                 ": what moves it? (a channel; hand: nothing but a hand; w: wiggle it; s: skip) ");
      if (word == "s") return false;
      if (word == "w") {
        Wiggle(bus, id);
        continue;
      }
      const auto channel = rig_.FindChannel(word);
      if (!channel && word != "hand") {
        std::printf("There is no channel \"%s\"%s\n", word.c_str(),
                    app::Suggestion(word, ChannelNames()).c_str());
        continue;
      }
      return TakeServo(bus, id, channel ? &rig_.channels[*channel] : nullptr);
    }
  }
  std::vector<std::string> ChannelNames() const {
    std::vector<std::string> names;
    for (const Channel& channel : rig_.channels) names.emplace_back(channel.name.view());
    return names;
  }

  servo::Servo Unlimited(const app::ServoBusConfig& bus, std::uint8_t id) const {
    servo::Servo servo;
    servo.name = *ShortName::From("servo");
    servo.bus = ShortName::From(bus.name).value_or(*ShortName::From("bus"));
    servo.id = id;
    return servo;
  }

  void Wiggle(const app::ServoBusConfig& bus, std::uint8_t id) {
    const StopFlag stop;
    try {
      Mover mover(Alone(bus, Unlimited(bus, id)), 0, clock_);
      mover.Open(kLongestSearch);
      const WholeWay way = WholeWayOf(bus);
      const float by = kWiggle * (way.high - way.low);
      const float at = mover.reads_back() ? mover.position() : mover.servo().neutral;
      for (const float to : {at + by, at - by, at + by, at}) {
        mover.GoTo(std::clamp(to, way.low, way.high));
        const Time end = clock_.Now() + std::chrono::seconds(5);
        do mover.Tick();
        while (!mover.arrived() && clock_.Now() < end && !stop.Raised());
      }
    } catch (const app::Failure& error) {
      std::printf("%s\n", error.what());
    }
  }

  bool TakeServo(const app::ServoBusConfig& bus, std::uint8_t id, const Channel* channel) {
    ShownServo shown{.name = NewName(channel, id),
                     .bus = bus.name,
                     .id = id,
                     .channel = channel,
                     .marks = {},
                     .max_speed_per_s = 0,
                     .unit = UnitOf(bus)};
    std::printf("Now show where it may go. Mark 1: %s; 2: %s; 3: at rest; then Enter.\n",
                channel == nullptr ? "one end" : "where its channel is at its least",
                channel == nullptr ? "the other" : "where it is at its most");
    std::fflush(stdout);
    const WholeWay way = WholeWayOf(bus);
    shown.max_speed_per_s = 100 * std::round(kUsualSpeed * (way.high - way.low) / 100);
    const StopFlag stop;
    try {
      Mover mover(Alone(bus, Unlimited(bus, id)), 0, clock_);
      mover.Open(kLongestSearch);
      Jog jog(mover, {.marks = true, .title = shown.name + ": " + MarksOf(channel)});
      RunJog(jog, mover, [&] { return stop.Raised(); });
      if (jog.confirmed()) shown.marks = jog.marks();
    } catch (const app::Failure& error) {
      std::printf("%s\n", error.what());
    }
    if (stop.Raised()) throw app::Failure("stopped; nothing was written");
    if (!shown.marks.neutral) {
      std::printf("Left out.\n");
      return false;
    }
    rig_text_ += (rig_text_.ends_with('\n') ? "" : "\n") + ServoBlock(shown);
    names_.push_back(shown.name);
    ++shown_;
    return true;
  }
  static std::string MarksOf(const Channel* channel) {
    if (channel == nullptr) return "1 and 2 are its ends, 3 is at rest";
    const std::string name(channel->name.view());
    return "1: " + name + " " + app::Printed(channel->min) + ", 2: " + name + " " +
           app::Printed(channel->max) + ", 3: at rest";
  }
  std::string NewName(const Channel* channel, std::uint8_t id) const {
    const std::string usual = channel != nullptr ? ServoName(std::string(channel->name.view()))
                                                 : "servo_" + std::to_string(id);
    for (;;) {
      std::string name = Answer("A name for it [" + usual + "]: ");
      if (name.empty()) name = usual;
      const bool taken = std::ranges::find(names_, name) != names_.end();
      if (!taken && ShortName::From(name)) return name;
      std::printf("%s\n",
                  taken ? "That is another servo already." : "Up to 31 letters, no spaces.");
    }
  }

  void Write() {
    if (options_.config.empty()) fs::create_directories(options_.out);
    CheckConfigText(config_file_, config_text_);
    ReplaceRig(rig_file_, rig_text_);
    OutputFile out(config_file_.string());
    out.Write(config_text_);
    out.Commit();
    std::printf(
        "\n%zu servos written to %s, their buses to %s.\n"
        "Next: facewire servo list --config %s, then facewired --config %s --check\n",
        shown_, rig_file_.c_str(), config_file_.c_str(), config_file_.c_str(),
        config_file_.c_str());
  }

  const WizardOptions& options_;
  hal::SystemClock clock_;
  fs::path config_file_, rig_file_, base_rig_;
  std::string config_text_, rig_text_;
  Rig rig_;
  servo::ServoRig servos_;
  std::vector<app::ServoBusConfig> buses_;
  std::vector<std::string> names_;  // of servos
  std::size_t shown_ = 0;
};

}  // namespace

void AddServoWizard(CLI::App& servo) {
  auto options = std::make_shared<WizardOptions>();
  CLI::App* command = servo.add_subcommand(
      "wizard", "From bare servos to a configuration that drives them, question by question");
  command->add_option("PORT", options->ports,
                      "Serial ports to search; without any, every one of this machine");
  command
      ->add_option("--kind", options->kinds,
                   "Only search buses of this kind; may be given more than once")
      ->check(CLI::IsMember({"receiver", "maestro", "dynamixel", "feetech"}))
      ->allow_extra_args(false);
  CLI::Option* out = command->add_option(
      "--out", options->out, "Write facewire.toml and rig.toml into this folder, as new files");
  command->add_option("--rig", options->rig, "The rig to begin with, instead of Otto's")
      ->needs(out);
  command->add_option("--config", options->config, "Add to this configuration and its rig instead")
      ->excludes(out);
  command->footer(
      "It searches the ports, gives new servos their ids on request, wiggles a servo so that you "
      "see which one it is,\n"
      "asks which channel of the rig moves it, and takes its limits and its direction by example, "
      "as\n"
      "`facewire servo limits` does. Nothing is written before the end.\n"
      "From a script: a line for each question, and words for the keys, as for jog.");
  command->callback([options] {
    if (options->out.empty() == options->config.empty()) {
      throw app::BadInput("--out DIR for new files, or --config F to add to a configuration");
    }
    Wizard(*options).Run();
  });
}

}  // namespace facewire::tools
