#ifndef FACEWIRE_HAL_CAMERA_INFO_H_
#define FACEWIRE_HAL_CAMERA_INFO_H_

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace facewire::hal {

// A size in a format, and the rates at which a camera delivers it.
struct CameraMode {
  std::string
      format;  // Name(CameraFormat), or the camera's own word for one that nobody here reads
  bool readable = false;  // whether facewire reads that format
  int width_px = 0;       // 0: the camera does not list its sizes, or takes any
  int height_px = 0;
  std::vector<double> fps = {};  // empty: not listed
  bool fps_range = false;        // fps are the fastest and the slowest; all between may be had
};

// A camera that is there, for a person who looks for the right one.
struct CameraInfo {
  std::string
      address;       // what facewire.toml calls it, across reboots and other ports where possible
  std::string node;  // what it is now, where that is something else: "/dev/video0"
  std::string name;  // the maker's
  std::vector<CameraMode> modes;
  // Why it cannot be used now: kPermission, kBusy, kIo; nullopt: it can.
  std::optional<Errc> problem;
  std::string holder;  // of a busy one, where the system tells: "cheese (process 4711)"
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_CAMERA_INFO_H_
