#include "hal/replay/video_decoder.h"

#include <dlfcn.h>

namespace facewire::hal::replay {

std::unique_ptr<VideoDecoder> LoadVideoDecoder(std::string& problem) {
  // By its name alone: the program's RUNPATH says in which folder it is. Never closed, because
  // what it loads has threads and exit handlers of its own; and a leak checker names functions only
  // where they still are.
  void* module = ::dlopen(FACEWIRE_VIDEO_MODULE, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* make = module == nullptr ? nullptr : ::dlsym(module, kMakeVideoDecoder);
  if (make == nullptr) {
    const char* why = ::dlerror();
    problem = std::string("playing a video needs the module " FACEWIRE_VIDEO_MODULE
                          ", which the package facewire installs: ") +
              (why == nullptr ? "it is another program's" : why);
    return nullptr;
  }
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): POSIX's way from dlsym to a call
  return std::unique_ptr<VideoDecoder>(reinterpret_cast<MakeVideoDecoder*>(make)());
}

}  // namespace facewire::hal::replay
