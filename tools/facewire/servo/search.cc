#include "tools/facewire/servo/search.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "app/devices.h"
#include "app/error.h"
#include "tools/facewire/servo/line.h"
#include "tools/facewire/servo/probe.h"

namespace facewire::tools {
namespace {

std::optional<FoundBus> Probe(Protocol protocol, Line& line, bool all_ids) {
  switch (protocol) {
    case Protocol::kReceiver:
      return ProbeReceiver(line);
    case Protocol::kMaestro:
      return ProbeMaestro(line);
    case Protocol::kDynamixel:
      return ProbeDynamixel(line);
    case Protocol::kFeetech:
      return ProbeFeetech(line, all_ids);
  }
  return std::nullopt;
}

bool IsChain(Protocol protocol) {
  return protocol == Protocol::kDynamixel || protocol == Protocol::kFeetech;
}

bool SameServos(const FoundBus& a, const FoundBus& b) {
  return std::ranges::equal(a.servos, b.servos, {}, &FoundServo::id, &FoundServo::id);
}

}  // namespace

PortSearch SearchPort(const std::string& path, const PortMaker& make, hal::Clock& clock,
                      const SearchPlan& plan,
                      const std::function<void(const std::string&)>& progress) {
  PortSearch search;
  for (const Protocol protocol : plan.protocols) {
    const std::span<const int> rates =
        plan.rates.empty() ? UsualRates(protocol) : std::span<const int>(plan.rates);
    std::string silent;
    for (const int rate : rates) {
      const auto port = make(rate);
      if (const Result<> opened = port->Open(); !opened) {
        if (opened.error() == Errc::kUnsupported && rates.size() > 1) continue;
        app::OpenSerialPort(*port, path, rate);
      }
      progress(path + ": " + Name(protocol) + " at " + std::to_string(rate) + " baud?");
      Line line(*port, clock);
      auto found = Probe(protocol, line, plan.all_ids);
      if (!found) {
        silent += (silent.empty() ? "" : ", ") + std::to_string(rate);
        continue;
      }
      // A line without a rate of its own (USB from end to end, a pseudo-terminal).
      if (!search.buses.empty() && SameServos(search.buses.front(), *found)) return search;
      found->port = path;
      found->baud = rate;
      search.buses.push_back(std::move(*found));
      if (!IsChain(protocol)) return search;
    }
    if (!silent.empty()) {
      search.tried.push_back(std::string(Name(protocol)) + " at " + silent + " baud");
    }
    if (!search.buses.empty()) return search;
  }
  return search;
}

std::vector<std::string> SerialPorts() {
  constexpr std::array<std::string_view, 3> kNames = {"ttyACM", "ttyUSB", "ttyAMA"};
  std::vector<std::string> ports;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    const std::string name = entry.path().filename().string();
    if (std::ranges::any_of(kNames,
                            [&](std::string_view start) { return name.starts_with(start); }))
      ports.push_back(entry.path().string());
  }
  std::ranges::sort(ports);
  return ports;
}

}  // namespace facewire::tools
