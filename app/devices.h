#ifndef FACEWIRE_APP_DEVICES_H_
#define FACEWIRE_APP_DEVICES_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "hal/camera.h"
#include "hal/camera_format.h"
#include "hal/clock.h"
#include "hal/playback.h"
#include "hal/serial_port.h"

// From what a person writes to the backend behind it, and from an Errc back to a line for a person.
namespace facewire::app {

// The line at `path`: a pseudo-terminal, a real tty, a service's socket, or a link to one. Which is
// looked up at every Open, because the device may come later than the program, or come back as
// another.
std::unique_ptr<hal::SerialPort> MakeSerialPort(const std::string& path, int baud);

// The line to the host by its address: "serial:PATH" as above, "pty:LINK" makes a pseudo-terminal
// and a link to it. BadInput for any other address.
std::unique_ptr<hal::SerialPort> MakeHostLine(const std::string& address, int baud);

// Why Open of the line that `name` stands for (a path or an address) failed, and what to do about
// it.
std::string DescribeSerialError(Errc error, const std::string& name, int baud);

// Opens; throws BadInput with that line when the line is not there, not free or not a serial line,
// and Failure for anything else.
void OpenSerialPort(hal::SerialPort& port, const std::string& name, int baud);

struct CameraOptions {
  int width_px = 640;  // of a live camera, as are height and fps; it may give its nearest
  int height_px = 480;
  double fps = 30;
  std::optional<hal::CameraFormat> format = {};  // of a live camera; nullopt: the best it has
  hal::Pace pace = hal::Pace::kRealTime;         // of a recording, as are loop and memory
  hal::LoopMode loop = hal::LoopMode::kNone;
  std::size_t memory_bytes = 0;  // see hal::replay::ReplayConfig
};

// The camera by its address: "v4l2:/dev/videoN" or "v4l2:" and a link to it, "replay:FILE" or just
// FILE (a video). Touches no device yet. BadInput for a camera that this program has no backend
// for. `clock` is borrowed.
std::unique_ptr<hal::Camera> MakeCamera(const std::string& address, const CameraOptions& options,
                                        hal::Clock& clock);

// Why Start of `camera` failed, or its Acquire, and what would be right.
std::string DescribeCameraError(Errc error, const hal::Camera& camera, const std::string& address);

// Starts; throws BadInput with that line when the camera or video is not there, not free or not
// usable, and Failure for anything else.
void StartCamera(hal::Camera& camera, const std::string& address);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_DEVICES_H_
