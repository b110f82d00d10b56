#include "app/speech.h"

#include <utility>
#include <variant>

namespace facewire::app {

Result<std::span<const std::byte>> NativeSpeech::NextOfPose(std::span<std::byte> out) noexcept {
  const wire::Pose* pose = std::exchange(pose_, nullptr);
  if (pose == nullptr) return Errc::kEnd;
  return encoder_.Encode(*pose, out);
}

Result<wire::Command> NativeSpeech::NextCommand(std::span<const std::byte>& bytes) noexcept {
  const auto received = decoder_.Next(bytes);
  if (!received) return received.error();
  const auto* command = std::get_if<wire::Command>(&received->message);
  if (command == nullptr) return Errc::kUnsupported;
  return *command;
}

Result<std::span<const std::byte>> OscSpeech::Charged(
    Result<std::span<const std::byte>> frame) noexcept {
  if (frame) share_.Charge(frame->size());
  return frame;
}

}  // namespace facewire::app
