#include "app/camera_list.h"

#include <iterator>
#include <utility>

#include "hal/libcamera/list.h"
#include "hal/v4l2/camera_list.h"

namespace facewire::app {

std::vector<hal::CameraInfo> ListCameras() {
  std::vector<hal::CameraInfo> cameras = hal::v4l2::ListCameras();
  std::vector<hal::CameraInfo> others = hal::libcamera::ListCameras();
  cameras.insert(cameras.end(), std::make_move_iterator(others.begin()),
                 std::make_move_iterator(others.end()));
  return cameras;
}

}  // namespace facewire::app
