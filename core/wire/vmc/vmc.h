#ifndef FACEWIRE_CORE_WIRE_VMC_VMC_H_
#define FACEWIRE_CORE_WIRE_VMC_VMC_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/wire/arkit/arkit.h"
#include "core/wire/osc/osc.h"

// The Virtual Motion Capture protocol (OSC over UDP 39539): VSeeFace, Warudo, and what animates VRM
// characters in Unity, Unreal, Blender and Godot. README.md here is the specification.
namespace facewire::wire::vmc {

// Which names a face's shapes have; README.md says who wants which.
enum class Names : std::uint8_t {
  kVrm0,   // "Blink_L", "A": every VRM 0 character has them, and the protocol asks for them
  kVrm1,   // "blinkLeft", "aa"
  kArkit,  // "EyeBlinkLeft", "JawOpen": all 52, "perfect sync"
};

// A datagram that no usual network cuts into pieces.
inline constexpr std::size_t kMaxPacketBytes = 1400;

struct Frame {
  arkit::Face face;
  bool tracking = false;
  float elapsed_s = 0;  // since the sender's start, of the capture
};

// A rotation as Unity has it: left-handed, x to the character's right, y up, z out of the face.
struct Quaternion {
  float x = 0, y = 0, z = 0, w = 1;
};
Quaternion UnityRotation(const HeadAngles& angles) noexcept;

// The mouth's vowels of VRM from the shapes that the networks see. All 0..1; the sum is at most 1.
struct Vowels {
  float a = 0, i = 0, u = 0, e = 0, o = 0;
};
Vowels VowelsOf(const arkit::Face& face) noexcept;

// The datagrams of one frame, one bundle after the other; the last ends with Blend/Apply.
//
//   FramePackets packets(names, frame);
//   while (const auto packet = packets.Next(buffer)) Send(*packet);
class FramePackets {
 public:
  FramePackets(Names names, const Frame& frame) noexcept;

  // The next one, at the front of `out`, at most kMaxPacketBytes. kEnd: that was the last. kFull:
  // `out` has not even room for one message (kMaxPacketBytes always has).
  Result<std::span<const std::byte>> Next(std::span<std::byte> out) noexcept;

 private:
  struct Shape {
    std::string_view name;
    float value = 0;
  };
  std::size_t MessageCount() const noexcept;
  Result<> Add(std::size_t index, osc::Writer& packet) const noexcept;
  Result<> AddBone(std::string_view name, const HeadAngles& angles,
                   osc::Writer& packet) const noexcept;
  void Push(std::string_view name, float value) noexcept { shapes_[count_++] = {name, value}; }

  Frame frame_;
  std::array<Shape, arkit::kShapes> shapes_{};
  std::size_t count_ = 0;
  std::size_t next_ = 0;  // of the messages
};

}  // namespace facewire::wire::vmc

#endif  // FACEWIRE_CORE_WIRE_VMC_VMC_H_
