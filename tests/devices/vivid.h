#ifndef FACEWIRE_TESTS_DEVICES_VIVID_H_
#define FACEWIRE_TESTS_DEVICES_VIVID_H_

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "hal/posix/unique_fd.h"
#include "tests/devices/sysfs.h"

// The kernel's virtual camera, from the side on which a real one has its lens and its plug.
// Documentation: the kernel's "The Virtual Video Test Driver (vivid)".
namespace facewire::devices {

// The node that the kernel calls `name`, such as "vivid-000-vid-cap"; "" when there is none.
inline std::string VideoNode(const std::string& name) {
  for (const auto& entry : std::filesystem::directory_iterator("/sys/class/video4linux")) {
    std::string found;
    std::getline(std::ifstream(entry.path() / "name") >> std::ws, found);
    if (found == name) return "/dev/" + entry.path().filename().string();
  }
  return "";
}

class Vivid {
 public:
  static constexpr const char* kCapture = "vivid-000-vid-cap";
  static constexpr const char* kPlanesCapture = "vivid-001-vid-cap";

  std::string node() const {
    std::string found = VideoNode(kCapture);
    if (found.empty()) throw std::runtime_error("vivid has no capture node");
    return found;
  }

  hal::posix::UniqueFd Open() const {
    return hal::posix::UniqueFd(::open(node().c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  }

  // Sets a control by the name that v4l2-ctl shows; pushes it when it is a button.
  void Set(const std::string& control, int value = 1) const {
    const hal::posix::UniqueFd fd = Open();
    v4l2_control wanted{.id = IdOf(fd.get(), control), .value = value};
    if (::ioctl(fd.get(), VIDIOC_S_CTRL, &wanted) != 0) {
      throw std::runtime_error("vivid refuses control " + control);
    }
  }

  // 0: a webcam, 1: a TV tuner.
  void SelectInput(int input) const {
    const hal::posix::UniqueFd fd = Open();
    if (::ioctl(fd.get(), VIDIOC_S_INPUT, &input) != 0) {
      throw std::runtime_error("vivid has no such input");
    }
  }

  // The whole device goes, with its nodes, whoever has it open; and comes back.
  static void Unplug() { Tell("/sys/bus/platform/drivers/vivid/unbind", "vivid.0"); }
  static void Plug() {
    Tell("/sys/bus/platform/drivers/vivid/bind", "vivid.0");
    WaitUntil("vivid's node", [] {
      const std::string found = VideoNode(kCapture);
      return !found.empty() && std::filesystem::exists(found);
    });
  }

 private:
  static std::uint32_t IdOf(int fd, const std::string& name) {
    v4l2_queryctrl query{};
    query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
    while (::ioctl(fd, VIDIOC_QUERYCTRL, &query) == 0) {
      if (name == reinterpret_cast<const char*>(query.name)) return query.id;
      query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    }
    throw std::runtime_error("vivid has no control " + name);
  }
};

}  // namespace facewire::devices

#endif  // FACEWIRE_TESTS_DEVICES_VIVID_H_
