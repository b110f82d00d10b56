#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/devices.h"
#include "app/error.h"
#include "core/wire/livelink/livelink.h"
#include "hal/system_clock.h"
#include "tools/facewire/bridge/bridge_session.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/stop_flag.h"
#include "tools/facewire/stream_port.h"

namespace facewire::tools {
namespace {

struct Options {
  std::string port;
  int baud = 115200;
  std::string vmc;
  std::string vmc_names = "vrm0";
  std::string livelink;
  std::string name;
  std::string ifacialmocap;
  int ifacialmocap_version = 1;
  bool listen = false;
};

void Say(const std::string& line) {
  std::fprintf(stdout, "%s\n", line.c_str());
  std::fflush(stdout);
}

wire::vmc::Names NamesOf(const std::string& text) {
  if (text == "vrm1") return wire::vmc::Names::kVrm1;
  return text == "arkit" ? wire::vmc::Names::kArkit : wire::vmc::Names::kVrm0;
}

std::vector<std::unique_ptr<FaceOutput>> MakeOutputs(const Options& options) {
  std::vector<std::unique_ptr<FaceOutput>> outputs;
  if (options.name.size() > wire::livelink::kMaxTextBytes) {
    throw app::BadInput("--name is longer than " + std::to_string(wire::livelink::kMaxTextBytes) +
                        " bytes");
  }
  if (!options.vmc.empty()) {
    outputs.push_back(std::make_unique<VmcOutput>(options.vmc, NamesOf(options.vmc_names)));
  }
  if (!options.livelink.empty()) {
    outputs.push_back(std::make_unique<LiveLinkOutput>(options.livelink, options.name));
  }
  if (!options.ifacialmocap.empty()) {
    outputs.push_back(std::make_unique<IFacialMocapOutput>(
        options.ifacialmocap,
        static_cast<wire::ifacialmocap::Version>(options.ifacialmocap_version)));
  }
  if (outputs.empty()) {
    throw app::BadInput(
        "nowhere to send to; give --vmc, --livelink or --ifacialmocap with HOST:PORT");
  }
  return outputs;
}

void Bridge(const Options& options) {
  const auto outputs = MakeOutputs(options);
  const auto port = MakeLine(options.port, options.baud);
  app::OpenSerialPort(*port, options.port, options.baud);
  const StopFlag stop;
  const std::string name = options.port == "-" ? "standard input" : options.port;
  hal::SystemClock clock;
  const auto session = std::make_unique<BridgeSession>(
      name, *port, clock, outputs,
      BridgeOptions{.may_write = !options.listen, .paced = IsStream(options.port)}, Say);
  session->Run([&] { return stop.Raised(); });

  std::string damaged;
  if (session->link().Damaged() > 0) {
    damaged = "; " + std::to_string(session->link().Damaged()) + " frames of the line were damaged";
  }
  if (session->poses() == 0 && !stop.Raised()) {
    throw app::BadInput(name + " holds no pose of a rig that it describes" + damaged);
  }
  std::string summary = std::to_string(session->poses()) + " poses";
  for (const auto& output : outputs) {
    const UdpSender& sender = output->sender();
    summary += "; " + std::to_string(sender.sent()) + " datagrams to " + sender.name();
    if (sender.failed() > 0) summary += ", " + std::to_string(sender.failed()) + " refused";
  }
  Say(summary + damaged);
}

}  // namespace

void AddBridge(CLI::App& facewire) {
  auto* command = facewire.add_subcommand(
      "bridge", "Send the poses of a line to Unreal, VSeeFace, Blender and other display programs");
  const auto options = std::make_shared<Options>();
  command
      ->add_option(
          "PORT", options->port,
          "A serial port, a pseudo-terminal, a recorded file, a FIFO, or - (standard input)")
      ->required();
  command->add_option("--vmc", options->vmc,
                      "HOST:PORT of a VMC receiver: VSeeFace, Warudo, Godot (port 39539)");
  command
      ->add_option("--vmc-names", options->vmc_names,
                   "Shapes as every VRM character has them, or all of a 'perfect sync' one")
      ->capture_default_str()
      ->check(CLI::IsMember({"vrm0", "vrm1", "arkit"}));
  command->add_option("--livelink", options->livelink,
                      "HOST:PORT of a Live Link Face receiver: Unreal (port 11111)");
  command->add_option("--name", options->name, "What Live Link lists; else the name of the rig");
  command->add_option("--ifacialmocap", options->ifacialmocap,
                      "HOST:PORT of an iFacialMocap receiver: Blender, VSeeFace (port 49983)");
  command
      ->add_option("--ifacialmocap-version", options->ifacialmocap_version,
                   "Of its text: 1 has - before values, 2 has &")
      ->capture_default_str()
      ->check(CLI::IsMember({1, 2}));
  command->add_option("--baud", options->baud, "Bits a second of a serial port")
      ->capture_default_str()
      ->check(CLI::Range(300, 4'000'000));
  command->add_flag("--listen", options->listen, "Never write: do not ask for the rig description");
  command->callback([options] { Bridge(*options); });
}

}  // namespace facewire::tools
