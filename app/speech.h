#ifndef FACEWIRE_APP_SPEECH_H_
#define FACEWIRE_APP_SPEECH_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/rig/rig.h"
#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "core/wire/message.h"
#include "core/wire/osc_host/command.h"
#include "core/wire/osc_host/encoder.h"
#include "core/wire/osc_host/line_share.h"
#include "core/wire/osc_host/pose_writer.h"

// What a line to the host speaks: from messages to bytes and back. HostLine asks for one frame
// after the other and decides what goes first; both kinds have the same functions.
namespace facewire::app {

// The native protocol (core/wire).
class NativeSpeech {
 public:
  void SetRig(const Rig& /*rig*/) noexcept {}
  void LineOpened() noexcept {}
  void BeginTick(Time /*now*/) noexcept {}

  // Frames of a pose, which is borrowed until NextOfPose says kEnd. False: it is not to be sent.
  bool BeginPose(const wire::Pose& pose) noexcept {
    pose_ = &pose;
    return true;
  }
  // Asking for the next says that the line took the one before. kEnd after the last.
  Result<std::span<const std::byte>> NextOfPose(std::span<std::byte> out) noexcept;

  // The frame of another message; errors as wire::Encoder.
  template <class Message>
  Result<std::span<const std::byte>> Encode(const Message& message,
                                            std::span<std::byte> out) noexcept {
    return encoder_.Encode(message, out);
  }
  // Whether the line carries another message of low priority in this tick.
  bool HasRoom() const noexcept { return true; }

  // Takes bytes off the front up to the end of a command. kNotReady: all were taken; other errors:
  // counted, go on.
  Result<wire::Command> NextCommand(std::span<const std::byte>& bytes) noexcept;
  const wire::LinkStats& received() const noexcept { return decoder_.stats(); }

 private:
  wire::Encoder encoder_;
  wire::Decoder decoder_;
  const wire::Pose* pose_ = nullptr;  // still to be asked for
};

// OSC in SLIP (core/wire/osc_host). It says no more than the line carries at its baud rate.
class OscSpeech {
 public:
  explicit OscSpeech(int baud) noexcept : share_(baud) {}

  void SetRig(const Rig& rig) noexcept { poses_.SetRig(rig); }
  void LineOpened() noexcept { poses_.Forget(); }
  void BeginTick(Time now) noexcept { share_.Advance(now); }

  bool BeginPose(const wire::Pose& pose) noexcept { return poses_.Begin(pose, share_.left()); }
  Result<std::span<const std::byte>> NextOfPose(std::span<std::byte> out) noexcept {
    return Charged(poses_.Next(out));
  }
  template <class Message>
  Result<std::span<const std::byte>> Encode(const Message& message,
                                            std::span<std::byte> out) noexcept {
    return Charged(wire::osc_host::Encode(message, out));
  }
  bool HasRoom() const noexcept { return share_.left() > 0; }

  Result<wire::Command> NextCommand(std::span<const std::byte>& bytes) noexcept {
    return commands_.Next(bytes);
  }
  const wire::LinkStats& received() const noexcept { return commands_.stats(); }

 private:
  Result<std::span<const std::byte>> Charged(Result<std::span<const std::byte>> frame) noexcept;

  wire::osc_host::LineShare share_;
  wire::osc_host::PoseWriter poses_;
  wire::osc_host::CommandDecoder commands_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_SPEECH_H_
