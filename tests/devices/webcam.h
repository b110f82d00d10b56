#ifndef FACEWIRE_TESTS_DEVICES_WEBCAM_H_
#define FACEWIRE_TESTS_DEVICES_WEBCAM_H_

#include <fcntl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "hal/posix/byte_stream.h"
#include "hal/posix/raw_mode.h"
#include "hal/posix/unique_fd.h"
#include "tests/devices/sysfs.h"
#include "tests/devices/vivid.h"

// The USB webcam that the emulated machine's host plays (uvc_webcam), from the side on which it has
// its plug: a serial line of the machine leads to the host's program.
namespace facewire::devices {

inline constexpr const char* kWebcamName = "Played Webcam";
inline constexpr const char* kWebcamById =
    "/dev/v4l/by-id/usb-facewire_Played_Webcam_FW0001-video-index0";
inline constexpr const char* kPictures = "/facewire/pictures";  // those that it shows

// Its node, "" while it is unplugged. The camera has a second one, for metadata, of the same name.
inline std::string WebcamNode() {
  std::error_code gone;
  return std::filesystem::canonical(kWebcamById, gone).string();
}

class Webcam {
 public:
  Webcam() : line_(::open("/dev/ttyS2", O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    if (!line_ || !hal::posix::SetRaw(line_.get()))
      throw std::runtime_error("no line to the webcam");
  }

  // As uvc_webcam/README.md lists them; its answer.
  std::string Tell(const std::string& command) const {
    const std::string text = command + "\n";
    const auto bytes = std::as_bytes(std::span(text));
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const Result<std::size_t> some =
          hal::posix::WriteFor(line_.get(), bytes.subspan(sent), std::chrono::seconds(10));
      if (!some) throw std::runtime_error("the webcam's host does not listen");
      sent += *some;
    }
    std::string answer;
    for (;;) {
      std::byte byte{};
      const Result<std::size_t> some =
          hal::posix::ReadFor(line_.get(), {&byte, 1}, std::chrono::seconds(10));
      if (!some) throw std::runtime_error("the webcam's host does not answer " + command);
      if (byte == std::byte{'\n'}) break;
      answer += static_cast<char>(byte);
    }
    if (answer.starts_with("error")) throw std::runtime_error(answer);
    return answer;
  }

  void Unplug() const {
    Tell("unplug");
    WaitUntil("the webcam to go", [] { return WebcamNode().empty(); });
  }
  // Until udev has made its link, after which everybody may know of it.
  void Plug() const {
    Tell("plug");
    WaitUntil("the webcam", [] { return !WebcamNode().empty(); });
  }

  // As new: plugged in, sending whole pictures at the rate that is asked for.
  void Reset() const {
    for (const char* command : {"resume", "damage 0", "rate negotiated"}) Tell(command);
    Plug();
  }

  // The files that it shows in a mode such as "mjpeg-640x480", in their order.
  static std::vector<std::vector<std::uint8_t>> Pictures(const std::string& mode) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(kPictures / std::filesystem::path(mode))) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::vector<std::uint8_t>> pictures;
    for (const auto& file : files) {
      std::ifstream in(file, std::ios::binary);
      pictures.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return pictures;
  }

 private:
  hal::posix::UniqueFd line_;
};

}  // namespace facewire::devices

#endif  // FACEWIRE_TESTS_DEVICES_WEBCAM_H_
