#ifndef FACEWIRE_TOOLS_FACEWIRE_POSE_WRITER_H_
#define FACEWIRE_TOOLS_FACEWIRE_POSE_WRITER_H_

#include <array>
#include <string>

#include "core/rig/rig.h"
#include "core/rig_pose.h"
#include "tools/facewire/output_file.h"

namespace facewire::tools {

// Of the head from where it was in the neutral: pitch, yaw, roll in degrees, x, y, z in cm.
using HeadMotion = std::array<float, 6>;

// Writes what `facewire retarget` gives, a line a frame; as CSV when the path ends in .csv, else as
// JSON lines. A frame without a face has the state "searching" and no values.
//   JSON: {"frame":0,"t_us":0,"state":"tracking","head":{"pitch":..,..,"z":..},
//          "bones":{"jaw":{"pos":[x,y,z],"rot":[pitch,yaw,roll]}},"params":{"jawOpen":0.31}}
//         pos in cm from the bone's rest, rot in degrees; an axis without a channel is 0
//   CSV:  frame,t_us,state,head.pitch,..,head.z,CHANNEL,..
class PoseWriter {
 public:
  // Throws BadInput when the path cannot be written to. The rig is borrowed.
  PoseWriter(const std::string& path, const Rig& rig);

  void Write(std::uint64_t frame, std::int64_t t_us, const HeadMotion& head, const RigPose& pose);
  void WriteLost(std::uint64_t frame, std::int64_t t_us);
  void Commit() { out_.Commit(); }

 private:
  void AppendBones(std::string& line, const RigPose& pose) const;
  void AppendParameters(std::string& line, const RigPose& pose) const;

  OutputFile out_;
  const Rig& rig_;
  bool csv_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_POSE_WRITER_H_
