#ifndef FACEWIRE_TOOLS_FACEWIRE_RECORDING_H_
#define FACEWIRE_TOOLS_FACEWIRE_RECORDING_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::tools {

// A pose as it came over the wire.
struct RecordedPose {
  RigPose pose;              // seq and captured are those of the wire
  std::uint32_t age_us = 0;  // from the capture of the picture to sending
  bool tracking = false;     // the rig followed a face
  bool holding = false;      // the face was just lost
};

// Reads what `facewire monitor --csv` wrote: frame,t_us,age_us,state,CHANNEL,... with a line a
// pose. The columns of channels must be those of the rig. Throws BadInput.
std::vector<RecordedPose> ReadEveryPose(const std::string& path, const Rig& rig);
// The same; of several poses for a frame (while a face is lost, the service goes on sending), the
// first is kept.
std::vector<RecordedPose> ReadRecording(const std::string& path, const Rig& rig);

// What can be said about a recording as a whole.
struct RecordingFigures {
  std::size_t frames = 0;
  double fps = 0;             // of the pictures that reached the rig
  double latency_p50_ms = 0;  // from capture to sending
  double latency_p99_ms = 0;
  std::size_t missed = 0;  // pictures that the camera took and the wire never showed
  std::size_t losses = 0;  // times that the face was lost
  std::size_t blinks = 0;  // times that both eyes of the character shut by half and opened again
};
RecordingFigures FiguresOf(const std::vector<RecordedPose>& recording, const Rig& rig);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_RECORDING_H_
