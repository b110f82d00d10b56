#ifndef FACEWIRE_TESTS_APP_FACEWIRED_H_
#define FACEWIRE_TESTS_APP_FACEWIRED_H_

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "core/wire/rig_description.h"
#include "hal/pty/pty_port.h"
#include "tests/app/process.h"
#include "tests/app/scratch.h"

// The program as a process beside the test, and the host at the other end of its line.
namespace facewire::app {

inline constexpr const char* kRig = FACEWIRE_SOURCE_DIR "/app/share/otto.toml";
inline constexpr const char* kProfile = FACEWIRE_SOURCE_DIR "/app/share/average.profile";

// A configuration of the mock hardware. `extra` comes behind it.
inline std::string Configuration(const std::string& extra = "", const std::string& rig = kRig,
                                 const std::string& profile = kProfile) {
  return "[camera]\ndevice = \"replay\"\n[camera.replay]\nfile = \"" FACEWIRE_ASSETS
         "/footage/franck.mp4\"\nmemory_mib = 64\nloop = \"ping-pong\"\n"
         "[tracker]\nnetworks = \"" FACEWIRE_ASSETS "/networks\"\n[character]\nrig = \"" +
         rig + "\"\nprofile = \"" + profile +
         "\"\n[neutral]\nfolder = \"state\"\nauto_s = 1.0\n[host]\nline = \"pty:line\"\n"
         "[states]\nstart_ramp_ms = 200\nease_ms = 300\n" +
         extra;
}

// What a host hears.
class Listener {
 public:
  explicit Listener(const std::filesystem::path& link) : port_(link.string()) {}

  // Listens until `done` says so; false when that takes too long.
  bool Until(const std::function<bool()>& done,
             std::chrono::seconds limit = std::chrono::seconds(60)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      Read();
    }
    return true;
  }

  // Asks for something, once the line is there.
  bool Say(const wire::Command& command) {
    std::array<std::byte, wire::kCommandFrameBytes> out;
    const auto frame = encoder_.Encode(command, out);
    return frame && open_ && port_.Write(*frame, std::chrono::milliseconds(100)) == frame->size();
  }

  wire::RigCollector rig;
  std::vector<wire::Pose> poses;
  std::vector<wire::Status> statuses;
  std::vector<wire::LandmarkPart> parts;
  bool hung_up = false;
  const wire::LinkStats& stats() const { return decoder_.stats(); }
  ServiceState state() const {
    return poses.empty() ? ServiceState::kStarting : poses.back().state;
  }

 private:
  void Read() {
    if (!open_) {
      open_ = port_.Open().has_value();
      if (!open_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return;
      }
    }
    std::array<std::byte, 4096> buffer;
    const auto read = port_.Read(buffer, std::chrono::milliseconds(100));
    if (!read) {
      hung_up = hung_up || read.error() == Errc::kDisconnected;
      if (hung_up) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      return;
    }
    std::span<const std::byte> rest = std::span(buffer).first(*read);
    for (;;) {
      const auto got = decoder_.Next(rest);
      if (!got) {
        if (got.error() == Errc::kNotReady) return;
        continue;
      }
      rig.Add(got->message);
      if (const auto* pose = std::get_if<wire::Pose>(&got->message)) poses.push_back(*pose);
      if (const auto* s = std::get_if<wire::Status>(&got->message)) statuses.push_back(*s);
      if (const auto* p = std::get_if<wire::LandmarkPart>(&got->message)) parts.push_back(*p);
    }
  }

  hal::pty::PtyPort port_;
  bool open_ = false;
  wire::Decoder decoder_;
  wire::Encoder encoder_;
};

class Facewired {
 public:
  explicit Facewired(const std::string& configuration) {
    scratch.Write("facewire.toml", configuration);
  }
  Process Start(std::vector<std::string> options = {},
                const std::vector<std::pair<std::string, std::string>>& environment = {}) {
    options.insert(options.begin(), {FACEWIRED, "--config", (scratch / "facewire.toml").string()});
    return Process(options, scratch / "out", scratch / "err", environment);
  }
  // kill -9. Its link stays behind, and the pseudo-terminal's number may be somebody else's soon: a
  // host that looks again must not hear that one.
  void Crash(Process& process) const {
    process.Signal(SIGKILL);
    EXPECT_EQ(process.Wait(), -1);
    std::filesystem::remove(scratch / "line");
  }
  Scratch scratch;
};

// Runs `facewire ARGUMENTS` to its end.
inline Process Tool(const Facewired& f, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), FACEWIRE_TOOL);
  return {arguments, f.scratch / "tool.out", f.scratch / "tool.err"};
}

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_FACEWIRED_H_
