#ifndef FACEWIRE_TOOLS_FACEWIRE_POSE_WRITER_H_
#define FACEWIRE_TOOLS_FACEWIRE_POSE_WRITER_H_

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::tools {

// Of the head from where it was in the neutral: pitch, yaw, roll in degrees, x, y, z in cm.
using HeadMotion = std::array<float, 6>;

// Writes what `facewire retarget` gives, frame by frame.
class PoseWriter {
 public:
  virtual ~PoseWriter() = default;
  virtual void Write(std::uint64_t frame, std::int64_t t_us, const HeadMotion& head,
                     const RigPose& pose) = 0;
  // A frame without a face.
  virtual void WriteLost(std::uint64_t frame, std::int64_t t_us) = 0;
  // Makes the file appear. Throws Failure. Nothing may be written after it.
  virtual void Commit() = 0;
};

// The writer for what the path ends in. A frame without a face has the state "searching" and no
// values in the first two, and holds the pose before it in the third.
//   else:  JSON lines, {"frame":0,"t_us":0,"state":"tracking","head":{"pitch":..,..,"z":..},
//          "bones":{"jaw":{"pos":[x,y,z],"rot":[pitch,yaw,roll]}},"params":{"jawOpen":0.31}}
//          pos in cm from the bone's rest, rot in degrees; an axis without a channel is 0
//   .csv:  frame,t_us,state,head.pitch,..,head.z,CHANNEL,..
//   .glb:  a glTF animation, see tools/gltf/README.md
// Throws BadInput when the path cannot be written to. The rig is borrowed.
std::unique_ptr<PoseWriter> OpenPoseWriter(const std::string& path, const Rig& rig);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_POSE_WRITER_H_
