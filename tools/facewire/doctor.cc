#include <fcntl.h>
#include <grp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/animatronic/drivers.h"
#include "app/camera_list.h"
#include "app/config.h"
#include "app/error.h"
#include "app/networks.h"
#include "app/profile_file.h"
#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "tools/facewire/camera_report.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/doctor_gpio.h"
#include "tools/facewire/face_reader.h"
#include "tools/facewire/finding.h"
#include "tools/facewire/json.h"

namespace facewire::tools {
namespace {

namespace fs = std::filesystem;

struct DoctorOptions {
  std::string config = "/etc/facewire/facewire.toml";
  std::string networks;
  bool json = false;
  bool cameras = false;
};

const char* Name(Verdict verdict) {
  return verdict == Verdict::kOk ? "OK" : verdict == Verdict::kWarn ? "WARN" : "FAIL";
}

// The first line of a message; its other lines are more of the same kind.
std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// Runs something that reports by exception.
Finding Try(const std::string& what, const std::string& good, const std::string& fix,
            const std::function<void()>& check) {
  try {
    check();
    return {what, Verdict::kOk, good, ""};
  } catch (const std::exception& error) {
    return {what, Verdict::kFail, FirstLine(error.what()), fix};
  }
}

Finding CheckNetworks(const DoctorOptions& options) {
  const fs::path folder = NetworksFolder(options.networks);
  return Try("networks", folder.string() + ", checksums right", "tools/setup", [&] {
    (void)app::LoadNetworks(folder, track::Model::kAttention);
    (void)app::LoadNetworks(folder, track::Model::kMesh);
  });
}

// Whether each servo is on a bus, and each bus is one that it can be on.
void CheckServos(const app::Config& config, const servo::ServoRig& servos,
                 std::vector<Finding>& findings) {
  const std::string count = std::to_string(servos.servos.size());
  if (config.buses.empty()) {
    if (servos.servos.empty()) return;
    findings.push_back({"servos", Verdict::kWarn, count + " in the rig, and no [[bus]] drives them",
                        "add a [[bus]] to the configuration; `facewire servo find` looks for one"});
    return;
  }
  findings.push_back(Try("servos", count + " on " + std::to_string(config.buses.size()) + " buses",
                         "facewired --check lists all that is wrong",
                         [&] { const app::Drivers drivers(config.buses, servos); }));
}

// The configuration, or none when there is none to be had.
std::optional<app::Config> CheckConfig(const DoctorOptions& options,
                                       std::vector<Finding>& findings) {
  if (!fs::exists(options.config)) {
    findings.push_back({"configuration", Verdict::kWarn, "there is no " + options.config,
                        "copy app/share/facewire.toml there, or name another with --config"});
    return std::nullopt;
  }
  app::Config config;
  findings.push_back(Try("configuration", options.config,
                         "facewired --check --config " + options.config,
                         [&] { config = app::LoadConfig(options.config); }));
  if (findings.back().verdict != Verdict::kOk) return std::nullopt;
  servo::ServoRig servos;
  findings.push_back(Try("rig", config.character.rig.string(), "correct [character] rig", [&] {
    servos = app::LoadServoRig(config.character.rig, app::LoadRig(config.character.rig));
  }));
  if (findings.back().verdict == Verdict::kOk) CheckServos(config, servos, findings);
  const auto check_profile = [&](const fs::path& path, const std::string& key) {
    if (path.empty()) return;
    findings.push_back(Try(key, path.string(), "correct [character] " + key,
                           [&] { (void)app::LoadProfile(path); }));
  };
  check_profile(config.character.profile, "profile");
  check_profile(config.character.personal, "personal");
  return config;
}

// Device nodes whose names begin with one of the prefixes, in order.
std::vector<std::string> Devices(std::initializer_list<std::string_view> prefixes) {
  std::vector<std::string> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev", ignored)) {
    const std::string name = entry.path().filename().string();
    if (std::ranges::any_of(prefixes, [&](std::string_view p) { return name.starts_with(p); })) {
      found.push_back(entry.path().string());
    }
  }
  std::ranges::sort(found);
  return found;
}

// The links that udev keeps for a device, whatever number it gets: " = LINK" for each.
std::string StableNames(const std::string& device) {
  std::string names;
  for (const char* folder : {"/dev/serial/by-id", "/dev/serial/by-path"}) {
    std::error_code ignored;
    for (const auto& link : fs::directory_iterator(folder, ignored)) {
      if (fs::equivalent(link.path(), device, ignored)) names += " = " + link.path().string();
    }
  }
  return names;
}

// Whether a device can be used, without a word to what hangs on it.
Finding CheckDevice(const std::string& what, const std::string& device, const std::string& group) {
  const int fd = open(device.c_str(), O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  const int error = errno;
  if (fd >= 0) {
    close(fd);
    return {what, Verdict::kOk, device + StableNames(device), ""};
  }
  if (error == EACCES) {
    return {what, Verdict::kFail, device + ": no permission",
            "sudo usermod -aG " + group + " $USER, then log in again"};
  }
  return {what, Verdict::kWarn, device + ": " + std::strerror(error),
          "end the program that holds it, or unplug it and plug it in again"};
}

// A serial port that the configuration names under `key`; `missing` is the verdict when it is not
// there.
Finding CheckPort(const std::string& what, const std::string& path, const std::string& key,
                  Verdict missing) {
  if (fs::exists(path)) return CheckDevice(what, path, "dialout");
  return {what, missing, "there is no port " + path,
          "plug it in, or correct " + key + "; the serial ports below are there"};
}

constexpr std::string_view kSerial = "serial:";

// The ports of the configuration's servo buses.
void CheckBuses(const app::Config& config, std::vector<Finding>& findings) {
  for (const app::ServoBusConfig& bus : config.buses) {
    if (!bus.port.starts_with(kSerial)) continue;  // a pseudo-terminal is made when it is needed
    findings.push_back(CheckPort("bus " + bus.name, bus.port.substr(kSerial.size()),
                                 "the [[bus]]'s port", Verdict::kFail));
  }
}

// The line to the host: whether it is there, and who understands what it speaks.
Finding CheckHostLine(const app::HostConfig& host) {
  const std::string what = "host line";
  if (host.line == "none") return {what, Verdict::kOk, "none: values go to servos alone", ""};
  const std::string speaks =
      host.protocol == app::HostProtocol::kOsc
          ? "OSC over SLIP: the page, facewire monitor and the bridges cannot read it"
          : "native protocol";
  if (!host.line.starts_with(kSerial)) {
    return {what, Verdict::kOk, host.line + ", which the service makes; " + speaks, ""};
  }
  // The service waits for its host, so nothing has to be put right before it starts.
  Finding finding =
      CheckPort(what, host.line.substr(kSerial.size()), "[host] line", Verdict::kWarn);
  finding.found += "; " + std::to_string(host.baud) + " baud, " + speaks;
  return finding;
}

void CheckDevices(const std::string& what, std::initializer_list<std::string_view> prefixes,
                  const std::string& group, std::vector<Finding>& findings) {
  const std::vector<std::string> devices = Devices(prefixes);
  if (devices.empty()) {
    findings.push_back({what, Verdict::kWarn, "none is plugged in",
                        "plug one in; dmesg shows whether it is seen"});
  }
  for (const std::string& device : devices) findings.push_back(CheckDevice(what, device, group));
}

void CheckCameras(std::vector<Finding>& findings) {
  const std::vector<hal::CameraInfo> cameras = app::ListCameras();
  if (cameras.empty()) {
    findings.push_back({"camera", Verdict::kWarn, "none is plugged in",
                        "plug one in; dmesg shows whether it is seen"});
  }
  for (const hal::CameraInfo& camera : cameras) {
    const std::string problem = ProblemOf(camera);
    const Verdict bad = camera.problem == Errc::kPermission ? Verdict::kFail : Verdict::kWarn;
    findings.push_back({"camera", problem.empty() ? Verdict::kOk : bad,
                        camera.address + (problem.empty() ? "" : ": " + problem), FixOf(camera)});
  }
}

Finding CheckGroup(const std::string& name) {
  if (geteuid() == 0) return {"group " + name, Verdict::kOk, "root needs none", ""};
  const group* entry = getgrnam(name.c_str());
  if (entry == nullptr) return {"group " + name, Verdict::kOk, "this system has none", ""};
  std::vector<gid_t> groups(static_cast<std::size_t>(std::max(getgroups(0, nullptr), 0)));
  const int count = getgroups(static_cast<int>(groups.size()), groups.data());
  groups.resize(static_cast<std::size_t>(std::max(count, 0)));
  if (getegid() == entry->gr_gid || std::ranges::find(groups, entry->gr_gid) != groups.end()) {
    return {"group " + name, Verdict::kOk, "you are in it", ""};
  }
  return {"group " + name, Verdict::kWarn, "you are not in it",
          "sudo usermod -aG " + name + " $USER, then log in again"};
}

Finding CheckClock() {
  timespec resolution{};
  if (clock_getres(CLOCK_MONOTONIC, &resolution) != 0) {
    return {"clock", Verdict::kFail, "there is no monotonic clock", "another kernel"};
  }
  if (resolution.tv_sec > 0 || resolution.tv_nsec > 1'000'000) {
    return {"clock", Verdict::kWarn, "coarse: " + std::to_string(resolution.tv_nsec / 1000) + " us",
            "a kernel with high-resolution timers"};
  }
  return {"clock", Verdict::kOk, "monotonic, " + std::to_string(resolution.tv_nsec) + " ns", ""};
}

Finding CheckMemoryLock() {
  constexpr rlim_t kNeeded = rlim_t{256} << 20U;  // more than the service holds without footage
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      limit.rlim_cur < kNeeded && geteuid() != 0) {
    return {
        "memory lock", Verdict::kWarn,
        std::to_string(limit.rlim_cur >> 20U) + " MiB may be locked; pages may go to disk",
        "run facewired under systemd with LimitMEMLOCK=infinity, or ulimit -l unlimited as root"};
  }
  return {"memory lock", Verdict::kOk, "enough", ""};
}

void PrintTable(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    std::printf("%-5s %-14s %s\n", Name(finding.verdict), finding.what.c_str(),
                finding.found.c_str());
    if (!finding.fix.empty()) std::printf("%-5s %-14s -> %s\n", "", "", finding.fix.c_str());
  }
}

void PrintJson(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    std::string line = "{\"check\":";
    json::AppendString(line, finding.what);
    line += ",\"verdict\":";
    json::AppendString(line, Name(finding.verdict));
    line += ",\"found\":";
    json::AppendString(line, finding.found);
    line += ",\"fix\":";
    json::AppendString(line, finding.fix);
    std::printf("%s}\n", line.c_str());
  }
}

void ListCameras(const DoctorOptions& options) {
  const std::vector<hal::CameraInfo> cameras = app::ListCameras();
  std::fputs((options.json ? CameraJson(cameras) : CameraTable(cameras)).c_str(), stdout);
  if (cameras.empty()) {
    throw app::Failure("doctor: there is no camera; plug one in, dmesg shows whether it is seen");
  }
  const auto usable = [](const hal::CameraInfo& camera) { return ProblemOf(camera).empty(); };
  if (std::ranges::none_of(cameras, usable)) {
    throw app::Failure("doctor: none of these cameras can be used as it is");
  }
}

void Doctor(const DoctorOptions& options) {
  if (options.cameras) {
    ListCameras(options);
    return;
  }
  std::vector<Finding> findings;
  findings.push_back(CheckNetworks(options));
  const std::optional<app::Config> config = CheckConfig(options, findings);
  CheckCameras(findings);
  if (config) {
    findings.push_back(CheckHostLine(config->host));
    CheckBuses(*config, findings);
  }
  CheckDevices("serial port", {"ttyACM", "ttyUSB", "ttyAMA", "ttyGS"}, "dialout", findings);
  std::ranges::move(CheckGpio(config ? &config->gpio : nullptr, hal::gpiod::SystemLibrary()),
                    std::back_inserter(findings));
  findings.push_back(CheckGroup("video"));
  findings.push_back(CheckGroup("dialout"));
  findings.push_back(CheckClock());
  findings.push_back(CheckMemoryLock());
  options.json ? PrintJson(findings) : PrintTable(findings);
  const auto failed = std::ranges::count(findings, Verdict::kFail, &Finding::verdict);
  if (failed > 0)
    throw app::Failure("doctor: " + std::to_string(failed) + " of these must be put right first");
}

}  // namespace

void AddDoctor(CLI::App& facewire) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = facewire.add_subcommand(
      "doctor", "Find what keeps this machine from working, and what fixes it");
  command->add_option("--config", options->config, "The service's configuration")
      ->capture_default_str();
  command->add_option(
      "--networks", options->networks,
      "Folder of the .tflite files; else FACEWIRE_NETWORKS, else the installed ones");
  command->add_flag("--cameras", options->cameras,
                    "Only list the cameras: the device line for facewire.toml, formats, sizes, "
                    "rates, and who holds one; exit code 1 when none can be used");
  command->add_flag("--json", options->json, "A JSON object a line instead of a table");
  command->footer(
      "OK: works. WARN: a part will not work. FAIL: must be put right first, exit code 1.");
  command->callback([options] { Doctor(*options); });
}

}  // namespace facewire::tools
