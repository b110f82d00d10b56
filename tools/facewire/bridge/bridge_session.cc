#include "tools/facewire/bridge/bridge_session.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>
#include <variant>

#include "app/error.h"
#include "core/wire/pose.h"

namespace facewire::tools {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLookEvery(20);                     // at a signal and at the clock
constexpr Duration kLongestGap = std::chrono::seconds(1);  // in a recording

// What the rig does not have, for a person; empty when nothing.
std::string Missing(const wire::arkit::FaceMap& map) {
  std::string missing;
  const auto add = [&](std::string_view what) {
    missing += (missing.empty() ? "" : ", ") + std::string(what);
  };
  for (std::size_t i = 0; i < wire::arkit::kShapes; ++i) {
    if (!map.HasShape(i)) add(wire::arkit::kShapeNames[i]);
  }
  if (!map.HasHead()) add("turns of a bone 'head' or 'neck'");
  if (!map.HasLeftEye()) add("turns of a bone 'eye_L'");
  if (!map.HasRightEye()) add("turns of a bone 'eye_R'");
  return missing;
}

}  // namespace

BridgeSession::BridgeSession(std::string port_name, hal::SerialPort& port, hal::Clock& clock,
                             const std::vector<std::unique_ptr<FaceOutput>>& outputs,
                             BridgeOptions options, std::function<void(const std::string&)> say)
    : name_(std::move(port_name)),
      port_(port),
      clock_(clock),
      outputs_(outputs),
      options_(options),
      say_(std::move(say)) {}

void BridgeSession::Run(const std::function<bool()>& stop) {
  std::array<std::byte, 4096> buffer;
  while (!stop()) {
    const Time now = clock_.Now();
    if (!open_) {
      Reopen(now);
      if (!open_) clock_.SleepUntil(now + kLookEvery);
      continue;
    }
    if (options_.may_write && !map_) question_.AskIfDue(now, port_);
    const auto read = port_.Read(buffer, kLookEvery);
    if (read) {
      Take(std::span(buffer).first(*read));
    } else if (read.error() == Errc::kEnd) {
      return;
    } else if (read.error() == Errc::kDisconnected || read.error() == Errc::kIo) {
      Lost(now, Name(read.error()));
    } else if (read.error() != Errc::kTimeout) {
      throw app::Failure("reading " + name_ + ": " + Name(read.error()));
    }
  }
}

void BridgeSession::Take(std::span<const std::byte> bytes) {
  if (osc_.Notices(bytes, decoder_.stats().frames)) say_(name_ + ": " + kSpeaksOsc);
  for (;;) {
    const auto received = decoder_.Next(bytes);
    if (!received && received.error() == Errc::kNotReady) return;
    if (!received) continue;
    if (rig_.Add(received->message)) {
      // Parts of another rig have already replaced the one that was there.
      if (!rig_.Complete()) map_.reset();
      if (rig_.Complete() && !map_) BeginRig();
    } else if (const auto* pose = std::get_if<wire::Pose>(&received->message)) {
      Use(*pose);
    }
  }
}

void BridgeSession::BeginRig() {
  rig_id_ = rig_.rig_id();
  map_.emplace(rig_.rig());
  for (const auto& output : outputs_) output->Begin(rig_.rig(), rig_id_);
  const std::string name(rig_.rig().name.view());
  const std::string missing = Missing(*map_);
  say_("the rig is " + (name.empty() ? "without a name" : name) +
       (missing.empty() ? "" : "; it lacks, and the receivers get as 0: " + missing));
}

void BridgeSession::Use(const wire::Pose& pose) {
  // A pose of another rig: that has to be described first.
  if (map_ && pose.rig_id != rig_id_) map_.reset();
  if (!map_) return;
  if (options_.paced) Wait(pose.captured);
  if (captured_) elapsed_ += std::max(Between(*captured_, pose.captured), Duration::zero());
  captured_ = pose.captured;
  const FaceMoment moment{.face = map_->FaceOf(wire::ValuesOf(pose, rig_.rig())),
                          .state = pose.state,
                          .captured = pose.captured,
                          .elapsed_s = Seconds(elapsed_)};
  for (const auto& output : outputs_) output->Send(moment);
  ++poses_;
}

// Gaps, and a device that started again, are not waited for.
void BridgeSession::Wait(Time captured) {
  if (!captured_) {
    due_ = clock_.Now();
    return;
  }
  due_ += std::clamp(Between(*captured_, captured), Duration::zero(), kLongestGap);
  clock_.SleepUntil(due_);
}

void BridgeSession::Lost(Time now, const char* what) {
  say_(name_ + ": the line is gone (" + what + "); trying to open it again");
  port_.Close();
  open_ = false;
  backoff_.Failed(now);
}

void BridgeSession::Reopen(Time now) {
  if (!backoff_.Due(now)) return;
  if (!port_.Open()) {
    backoff_.Failed(now);
    return;
  }
  backoff_.Succeeded();
  open_ = true;
  say_(name_ + ": the line is back");
}

}  // namespace facewire::tools
