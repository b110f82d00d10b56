#ifndef FACEWIRE_TOOLS_FACEWIRE_CAMERA_REPORT_H_
#define FACEWIRE_TOOLS_FACEWIRE_CAMERA_REPORT_H_

#include <string>
#include <vector>

#include "hal/camera_info.h"

// What there is to say about the cameras of a machine.
namespace facewire::tools {

// What keeps a camera from being used; empty: nothing.
std::string ProblemOf(const hal::CameraInfo& camera);
// The command that puts it right, or what to do; empty: nothing is wrong.
std::string FixOf(const hal::CameraInfo& camera);

// Some lines for each camera: its name, the line for facewire.toml, what is wrong, and a line for
// each size that it has in a format.
std::string CameraTable(const std::vector<hal::CameraInfo>& cameras);
// A JSON object on a line of its own for each camera:
// {"address":"v4l2:..","node":"..","name":"..","problem":"","fix":"","modes":[{"format":"yuyv",
// "readable":true,"width_px":640,"height_px":480,"fps":[30,15],"fps_range":false}]}
std::string CameraJson(const std::vector<hal::CameraInfo>& cameras);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_CAMERA_REPORT_H_
