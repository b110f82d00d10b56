#include "app/camera_list.h"

#include "hal/v4l2/camera_list.h"

namespace facewire::app {

std::vector<hal::CameraInfo> ListCameras() { return hal::v4l2::ListCameras(); }

}  // namespace facewire::app
