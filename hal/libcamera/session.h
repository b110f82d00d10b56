#ifndef FACEWIRE_HAL_LIBCAMERA_SESSION_H_
#define FACEWIRE_HAL_LIBCAMERA_SESSION_H_

#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/libcamera/hand_over.h"
#include "hal/libcamera/mapped_buffer.h"
#include "hal/libcamera/mode_choice.h"

namespace facewire::hal::libcamera {

struct LibcameraConfig {
  // The camera's stable id as libcamera prints it, or its number in libcamera's list.
  std::string camera = "0";
  // What is asked for. A camera that cannot do it gives what comes nearest.
  int width_px = 640;
  int height_px = 480;
  double fps = 30;
  double lowest_fps = 10;  // a camera that says it is slower is refused: the rig would stutter
  // What may be taken, best first.
  std::vector<CameraFormat> formats{std::begin(kEveryCameraFormat), std::end(kEveryCameraFormat)};
  // More ride out a longer stall of the program, and cost a picture's memory each. Some cameras
  // insist on a number of their own.
  int buffer_count = 4;  // 2..16
};

// What was agreed on with a camera.
struct Negotiated {
  std::string id;
  std::string model;  // as people call it; empty when it does not say
  Mode mode;
  unsigned stride_bytes = 0;  // of the first plane; 0: packed
  YuvEncoding yuv = YuvEncoding::kBt601Limited;
  double fps = 0;  // 0: the camera does not let itself be told
};

// One camera of libcamera that streams, from Open to Close. The seam to the library: tests put a
// camera of their own here, which fails as no real one does on demand. One thread calls everything.
class Session {
 public:
  virtual ~Session() = default;  // closes

  // Finds the camera, agrees on a mode, allocates and maps the buffers, streams. Pictures come to
  // `hand_over` from a thread of the session's, until Close. After an error nothing is held.
  // kNotFound, kBusy, kPermission, kUnsupported, kIo.
  virtual Result<Negotiated> Open(const LibcameraConfig& config, HandOver& hand_over) = 0;
  virtual std::span<const MappedBuffer> buffers() const = 0;
  // Gives a buffer back to be filled again; false when the camera does not take it.
  virtual bool Queue(int buffer) = 0;
  virtual void Close() = 0;

  // Why Open failed, for a person, without the camera's name.
  virtual const std::string& reason() const = 0;
};

// libcamera itself. It allows one streaming camera (or listing) in a program at a time; another
// Open is kBusy.
std::unique_ptr<Session> MakeLibrarySession();

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_HAL_LIBCAMERA_SESSION_H_
