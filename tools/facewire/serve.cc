#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "app/backoff.h"
#include "app/devices.h"
#include "app/error.h"
#include "hal/system_clock.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/line_server.h"
#include "tools/facewire/listen_address.h"
#include "tools/facewire/other_protocol.h"
#include "tools/facewire/servo/search.h"
#include "tools/facewire/stop_flag.h"

namespace facewire::tools {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kReadFor(4);  // so long the network may wait for the line
constexpr milliseconds kWriteFor(20);

struct Options {
  std::string port;
  int baud = 115200;
  std::string address = "127.0.0.1";
  int web_port = 8080;
  std::string page;
};

std::filesystem::path Page(const std::string& asked) {
  const std::filesystem::path installed = FACEWIRE_INSTALLED_SHARE "/page";
  std::filesystem::path page = asked;
  if (page.empty()) page = std::filesystem::exists(installed) ? installed : FACEWIRE_BUILT_PAGE;
  if (!std::filesystem::exists(page / "index.html")) {
    throw app::BadInput(page.string() + " has no index.html: --page names the folder of the page");
  }
  return page;
}

// What a person gives who does not know the port's name yet.
[[noreturn]] void AskForPort() {
  std::string there;
  for (const std::string& port : SerialPorts()) there += (there.empty() ? "" : ", ") + port;
  throw app::BadInput("PORT is required; " + (there.empty()
                                                  ? "no serial port is here: plug the device in"
                                                  : "the serial ports here: " + there));
}

// The serial line, opened again whenever it went.
class Line {
 public:
  explicit Line(const Options& options)
      : name_(options.port), port_(app::MakeSerialPort(options.port, options.baud)) {
    app::OpenSerialPort(*port_, options.port, options.baud);
  }

  // What came within kReadFor; empty when nothing did.
  std::span<const std::byte> Read() {
    if (!open_ && !Reopen()) return {};
    const auto read = port_->Read(buffer_, kReadFor);
    if (read) return Noticed(std::span(buffer_).first(*read));
    if (read.error() != Errc::kTimeout) Lost();
    return {};
  }
  // Commands are repeated by whoever waits for an answer, so what does not get through is dropped.
  void Write(std::span<const std::byte> bytes) {
    if (open_ && !bytes.empty()) (void)port_->Write(bytes, kWriteFor);
  }

 private:
  void Lost() {
    open_ = false;
    port_->Close();
    std::fprintf(stderr, "facewire: %s is gone, waiting for it\n", name_.c_str());
  }
  std::span<const std::byte> Noticed(std::span<const std::byte> bytes) {
    if (osc_.Notices(bytes, 0)) {
      std::fprintf(stderr, "facewire: %s: %s\n", name_.c_str(), kSpeaksOsc);
    }
    return bytes;
  }
  bool Reopen() {
    const Time now = clock_.Now();
    if (backoff_.Due(now)) {
      open_ = port_->Open().has_value();
      if (!open_) backoff_.Failed(now);
    }
    if (open_) {
      backoff_.Succeeded();
      std::fprintf(stderr, "facewire: %s is back\n", name_.c_str());
    } else {
      std::this_thread::sleep_for(kReadFor);
    }
    return open_;
  }

  std::string name_;
  std::unique_ptr<hal::SerialPort> port_;
  hal::SystemClock clock_;
  app::Backoff backoff_;
  OscSpotter osc_;
  bool open_ = true;
  std::array<std::byte, 4096> buffer_{};
};

void Serve(const Options& options) {
  if (options.port.empty()) AskForPort();
  const auto page = Page(options.page);
  const std::string address = ListenAddress(options.address, options.web_port);
  Line line(options);
  LineServer server({.address = address, .port = options.web_port, .files = page});
  const StopFlag stop;
  std::printf("http://%s:%d/\n",
              options.address == "0.0.0.0" ? "localhost" : options.address.c_str(), server.port());
  std::fflush(stdout);
  while (!stop.Raised()) {
    const auto bytes = line.Read();
    if (!bytes.empty()) server.Send(bytes);
    line.Write(server.Service());
  }
}

}  // namespace

void AddServe(CLI::App& facewire) {
  auto* command = facewire.add_subcommand(
      "serve", "Show the character in a browser: the page, and a line's bytes for it");
  const auto options = std::make_shared<Options>();
  command->add_option("PORT", options->port,
                      "The device's line: a serial port or a pseudo-terminal; without it, an error "
                      "names the serial ports that are here");
  command->add_option("--baud", options->baud, "Bits a second of a serial port")
      ->capture_default_str()
      ->check(CLI::Range(300, 4'000'000));
  command
      ->add_option(
          "--address", options->address,
          "Where to listen: an address of this machine, 0.0.0.0 for all. Whoever reaches it "
          "may send commands to the device")
      ->capture_default_str();
  command->add_option("--web-port", options->web_port, "The port of the page; 0: any that is free")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command->add_option("--page", options->page, "The folder of the page, if not the installed one");
  command->callback([options] { Serve(*options); });
}

}  // namespace facewire::tools
