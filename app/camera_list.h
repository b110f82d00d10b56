#ifndef FACEWIRE_APP_CAMERA_LIST_H_
#define FACEWIRE_APP_CAMERA_LIST_H_

#include <vector>

#include "hal/camera_info.h"

namespace facewire::app {

// The live cameras of every backend that this program has. One that two backends know comes twice.
std::vector<hal::CameraInfo> ListCameras();

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CAMERA_LIST_H_
