#ifndef FACEWIRE_HAL_V4L2_CAMERA_LIST_H_
#define FACEWIRE_HAL_V4L2_CAMERA_LIST_H_

#include <filesystem>
#include <vector>

#include "hal/camera_info.h"
#include "hal/v4l2/system_calls.h"

namespace facewire::hal::v4l2 {

// Where Linux shows its devices; tests show others.
struct DevicePlaces {
  std::filesystem::path dev = "/dev";
  std::filesystem::path names = "/sys/class/video4linux";
  std::filesystem::path processes = "/proc";
};

// The nodes that capture pictures, by their numbers, and those that nobody may ask. Starts none,
// and disturbs none that another program uses.
std::vector<CameraInfo> ListCameras(SystemCalls& calls = LinuxCalls(),
                                    const DevicePlaces& places = {});

}  // namespace facewire::hal::v4l2

#endif  // FACEWIRE_HAL_V4L2_CAMERA_LIST_H_
