#include "hal/v4l2/camera_list.h"

#include <fcntl.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include "hal/posix/errors.h"
#include "hal/v4l2/fourcc.h"
#include "hal/v4l2/frame_rate.h"

namespace facewire::hal::v4l2 {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMostListed = 64;  // a driver that never ends is no reason to hang

// Of a camera that scales, the sizes worth naming.
constexpr std::pair<std::uint32_t, std::uint32_t> kUsualSizes[] = {
    {320, 240}, {640, 480}, {1280, 720}, {1920, 1080}};

class Device {
 public:
  Device(SystemCalls& calls, const fs::path& node) : calls_(calls) {
    do {
      fd_ = calls_.Open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    } while (fd_ < 0 && errno == EINTR);
    error_ = fd_ < 0 ? errno : 0;
  }
  ~Device() {
    if (fd_ >= 0) calls_.Close(fd_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  int error() const { return error_; }  // of opening it; 0: it is open
  bool Ask(unsigned long request, void* argument) {
    return Call(calls_, fd_, request, argument) == 0;
  }
  FrameRates Rates(std::uint32_t fourcc, std::uint32_t width_px, std::uint32_t height_px) {
    return ReadFrameRates(calls_, fd_, fourcc, width_px, height_px);
  }

 private:
  SystemCalls& calls_;
  int fd_ = -1;
  int error_ = 0;
};

// The nodes videoN by N.
std::vector<fs::path> Nodes(const fs::path& dev) {
  constexpr std::string_view kPrefix = "video";
  std::vector<std::pair<int, fs::path>> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(dev, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPrefix)) continue;
    const std::string number = name.substr(kPrefix.size());
    if (number.empty() || number.size() > 6 ||
        !std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; })) {
      continue;
    }
    found.emplace_back(std::stoi(number), entry.path());
  }
  std::ranges::sort(found);
  std::vector<fs::path> nodes;
  nodes.reserve(found.size());
  for (auto& [number, path] : found) nodes.push_back(std::move(path));
  return nodes;
}

// The link of udev that stays the same: by the camera's own name, else by its port.
fs::path StablePath(const fs::path& dev, const fs::path& node) {
  for (const char* folder : {"v4l/by-id", "v4l/by-path"}) {
    std::vector<fs::path> links;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(dev / folder, ignored)) {
      if (fs::equivalent(entry.path(), node, ignored)) links.push_back(entry.path());
    }
    if (!links.empty()) return *std::ranges::min_element(links);
  }
  return node;
}

std::string FirstLine(const fs::path& file) {
  std::string line;
  std::getline(std::ifstream(file), line);
  return line;
}

// "cheese (process 4711)"; empty when nobody is seen to have the node open. Processes of others
// show only to root.
std::string HolderOf(const fs::path& processes, const fs::path& node) {
  std::error_code ignored;
  for (const auto& process : fs::directory_iterator(processes, ignored)) {
    for (const auto& file : fs::directory_iterator(process.path() / "fd", ignored)) {
      if (fs::read_symlink(file.path(), ignored) != node) continue;
      return FirstLine(process.path() / "comm") + " (process " +
             process.path().filename().string() + ")";
    }
  }
  return "";
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> Sizes(Device& device, std::uint32_t fourcc) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_frmsizeenum size{};
    size.index = i;
    size.pixel_format = fourcc;
    if (!device.Ask(VIDIOC_ENUM_FRAMESIZES, &size)) break;
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      sizes.emplace_back(size.discrete.width, size.discrete.height);
      continue;
    }
    const v4l2_frmsize_stepwise& range = size.stepwise;
    for (const auto& [width, height] : kUsualSizes) {
      if (width >= range.min_width && width <= range.max_width && height >= range.min_height &&
          height <= range.max_height) {
        sizes.emplace_back(width, height);
      }
    }
    break;
  }
  if (sizes.empty()) sizes.emplace_back(0, 0);
  return sizes;
}

std::vector<CameraMode> Modes(Device& device) {
  std::vector<CameraMode> modes;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_fmtdesc description{};
    description.index = i;
    description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (!device.Ask(VIDIOC_ENUM_FMT, &description)) break;
    const std::uint32_t fourcc = description.pixelformat;
    const std::optional<CameraFormat> format = FormatOf(fourcc);
    for (const auto& [width, height] : Sizes(device, fourcc)) {
      CameraMode mode;
      mode.format = format ? std::string(Name(*format)) : FourccText(fourcc).data();
      mode.readable = format.has_value();
      mode.width_px = static_cast<int>(width);
      mode.height_px = static_cast<int>(height);
      const FrameRates rates = device.Rates(fourcc, width, height);
      for (const Period& period : rates.periods) mode.fps.push_back(period.fps());
      mode.fps_range = rates.range;
      modes.push_back(std::move(mode));
    }
  }
  return modes;
}

// False: not a node that captures pictures.
bool Look(SystemCalls& calls, CameraInfo& camera) {
  Device device(calls, camera.node);
  if (device.error() != 0) {
    camera.problem = posix::OpenError(device.error());
    return camera.problem != Errc::kNotFound;
  }
  v4l2_capability capability{};
  if (!device.Ask(VIDIOC_QUERYCAP, &capability)) return false;
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                ? capability.device_caps
                                : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0) return false;
  camera.name = reinterpret_cast<const char*>(capability.card);
  camera.modes = Modes(device);
  // No buffers are the right of whoever has the stream, and harmless when nobody has it.
  v4l2_requestbuffers none{};
  none.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  none.memory = V4L2_MEMORY_MMAP;
  if (!device.Ask(VIDIOC_REQBUFS, &none) && errno == EBUSY) camera.problem = Errc::kBusy;
  return true;
}

}  // namespace

std::vector<CameraInfo> ListCameras(SystemCalls& calls, const DevicePlaces& places) {
  std::vector<CameraInfo> cameras;
  for (const fs::path& node : Nodes(places.dev)) {
    CameraInfo camera;
    camera.node = node.string();
    camera.name = FirstLine(places.names / node.filename() / "name");
    if (!Look(calls, camera)) continue;
    camera.address = "v4l2:" + StablePath(places.dev, node).string();
    if (camera.problem == Errc::kBusy) camera.holder = HolderOf(places.processes, node);
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace facewire::hal::v4l2
