#ifndef FACEWIRE_HAL_LIBCAMERA_LIST_H_
#define FACEWIRE_HAL_LIBCAMERA_LIST_H_

#include <string>
#include <vector>

#include "core/base/result.h"
#include "hal/libcamera/mode_choice.h"

namespace facewire::hal::libcamera {

struct ListedCamera {
  std::string id;           // "libcamera:" and this is its address
  std::string model;        // as people call it; empty when it does not say
  std::vector<Mode> modes;  // those that facewire can use; a camera of free size lists usual ones
};

// The cameras that libcamera has, in its order: "libcamera:0" is the first. kBusy: a camera of this
// program streams through libcamera. kPermission: there are media devices, none of which may be
// opened.
Result<std::vector<ListedCamera>> ListCameras();

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_HAL_LIBCAMERA_LIST_H_
