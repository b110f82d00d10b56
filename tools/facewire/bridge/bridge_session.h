#ifndef FACEWIRE_TOOLS_FACEWIRE_BRIDGE_BRIDGE_SESSION_H_
#define FACEWIRE_TOOLS_FACEWIRE_BRIDGE_BRIDGE_SESSION_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/backoff.h"
#include "core/wire/decoder.h"
#include "core/wire/rig_description.h"
#include "hal/clock.h"
#include "hal/serial_port.h"
#include "tools/facewire/bridge/outputs.h"
#include "tools/facewire/other_protocol.h"
#include "tools/facewire/rig_question.h"

namespace facewire::tools {

struct BridgeOptions {
  bool may_write = true;  // false: never asks the device for anything
  bool paced = false;     // a recording: poses go out as far apart as they were captured
};

// From a line to the receivers: every pose of a rig that is known goes to each output.
class BridgeSession {
 public:
  // Everything is borrowed. `say` gets lines for the person: what the rig lacks, a line that is
  // lost or back.
  BridgeSession(std::string port_name, hal::SerialPort& port, hal::Clock& clock,
                const std::vector<std::unique_ptr<FaceOutput>>& outputs, BridgeOptions options,
                std::function<void(const std::string&)> say);

  // Returns when `stop` (asked 50 times a second) says so, or the recording ends. A line that is
  // lost is opened again, sooner or later. Throws Failure when reading fails in another way.
  void Run(const std::function<bool()>& stop);

  std::uint64_t poses() const noexcept { return poses_; }  // that were sent
  const wire::LinkStats& link() const noexcept { return decoder_.stats(); }

 private:
  void Take(std::span<const std::byte> bytes);
  void Use(const wire::Pose& pose);
  void BeginRig();
  void Wait(Time captured);
  void Lost(Time now, const char* what);
  void Reopen(Time now);

  std::string name_;
  hal::SerialPort& port_;
  hal::Clock& clock_;
  const std::vector<std::unique_ptr<FaceOutput>>& outputs_;
  BridgeOptions options_;
  std::function<void(const std::string&)> say_;
  wire::Decoder decoder_;
  wire::RigCollector rig_;
  RigQuestion question_;
  OscSpotter osc_;
  std::optional<wire::arkit::FaceMap> map_;  // of the rig with rig_id_
  std::uint32_t rig_id_ = 0;
  std::optional<Time> captured_;  // of the last pose
  Duration elapsed_{};            // from the first pose to the last
  Time due_{};                    // when the last pose of a recording was
  std::uint64_t poses_ = 0;
  bool open_ = true;
  app::Backoff backoff_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_BRIDGE_BRIDGE_SESSION_H_
