#ifndef FACEWIRE_HAL_LIBCAMERA_LIST_H_
#define FACEWIRE_HAL_LIBCAMERA_LIST_H_

#include <vector>

#include "hal/camera_info.h"

namespace facewire::hal::libcamera {

// The cameras that libcamera has, in its order: "libcamera:0" is the first. Their addresses are the
// stable ones, "libcamera:ID"; of their modes those that facewire reads, without rates, which
// libcamera does not list. None while a camera of this program streams through libcamera.
std::vector<CameraInfo> ListCameras();

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_HAL_LIBCAMERA_LIST_H_
