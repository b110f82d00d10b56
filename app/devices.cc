#include "app/devices.h"

#include <string_view>
#include <utility>

#include "app/error.h"
#include "hal/libcamera/libcamera_camera.h"
#include "hal/local/local_port.h"
#include "hal/pty/pty_host.h"
#include "hal/pty/pty_port.h"
#include "hal/replay/replay_camera.h"
#include "hal/serialport/serialport_port.h"
#include "hal/v4l2/v4l2_camera.h"

namespace facewire::app {
namespace {

constexpr std::string_view kSerial = "serial:";
constexpr std::string_view kPty = "pty:";
constexpr std::string_view kV4l2 = "v4l2:";
constexpr std::string_view kReplay = "replay:";
constexpr std::string_view kLibcamera = "libcamera:";

// `text` without `prefix`, which it starts with or not.
std::string Without(const std::string& text, std::string_view prefix) {
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

// Whatever is at the path when it is opened.
class SerialLine final : public hal::SerialPort {
 public:
  SerialLine(const std::string& path, int baud)
      : path_(path), local_(path), pty_(path, baud), tty_({.path = path, .baud = baud}) {}

  Result<> Open() override {
    hal::SerialPort* chosen = &tty_;
    if (hal::pty::IsPseudoTerminal(path_).value_or(false)) chosen = &pty_;
    if (hal::local::IsSocket(path_).value_or(false)) chosen = &local_;
    if (chosen != active_) active_->Close();
    active_ = chosen;
    return active_->Open();
  }
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds timeout) override {
    return active_->Write(bytes, timeout);
  }
  Result<std::size_t> Read(std::span<std::byte> buffer,
                           std::chrono::milliseconds timeout) override {
    return active_->Read(buffer, timeout);
  }
  std::size_t Unsent() override { return active_->Unsent(); }
  void Close() override { active_->Close(); }

 private:
  std::string path_;
  hal::local::LocalPort local_;
  hal::pty::PtyPort pty_;
  hal::serialport::SerialportPort tty_;
  hal::SerialPort* active_ = &tty_;
};

// What any live camera is asked for.
template <class Config>
Config LiveCamera(const CameraOptions& options) {
  Config config;
  config.width_px = options.width_px;
  config.height_px = options.height_px;
  config.fps = options.fps;
  if (options.format) config.formats = {*options.format};
  return config;
}

// What the person can put right, as opposed to what failed at work.
bool IsInput(Errc error) {
  return error == Errc::kNotFound || error == Errc::kBusy || error == Errc::kPermission ||
         error == Errc::kUnsupported || error == Errc::kInvalidArgument || error == Errc::kFull;
}

[[noreturn]] void Throw(Errc error, const std::string& line) {
  if (IsInput(error)) throw BadInput(line);
  throw Failure(line);
}

}  // namespace

std::unique_ptr<hal::SerialPort> MakeSerialPort(const std::string& path, int baud) {
  return std::make_unique<SerialLine>(path, baud);
}

std::unique_ptr<hal::SerialPort> MakeHostLine(const std::string& address, int baud) {
  if (address.starts_with(kPty)) {
    return std::make_unique<hal::pty::PtyHost>(Without(address, kPty));
  }
  if (address.starts_with(kSerial)) return MakeSerialPort(Without(address, kSerial), baud);
  throw BadInput("'" + address + "' is no line to a host; give serial:PATH or pty:LINK");
}

std::string DescribeSerialError(Errc error, const std::string& name, int baud) {
  if (name.starts_with(kPty)) {
    const std::string link = Without(name, kPty);
    switch (error) {
      case Errc::kNotFound:
        return "the folder of the link " + link + " does not exist; make it first";
      case Errc::kBusy:
        return link + " exists and is not a link; move it away or choose another name";
      case Errc::kPermission:
        return "no permission to make the link " + link;
      default:
        return "making a pseudo-terminal for " + link + ": " + Name(error);
    }
  }
  const std::string path = Without(name, kSerial);
  switch (error) {
    case Errc::kNotFound:
      return "there is no port " + path + "; `facewire doctor` lists those there are";
    case Errc::kBusy:
      return path + " is in use by another program; end that one first";
    case Errc::kPermission:
      return "no permission to open " + path + "; the user must be in its group, usually 'dialout'";
    case Errc::kUnsupported:
      return path + " is not a serial line that can do " + std::to_string(baud) + " baud";
    case Errc::kDisconnected:
      return path + " has been unplugged or hung up";
    default:
      return "opening " + path + ": " + Name(error);
  }
}

void OpenSerialPort(hal::SerialPort& port, const std::string& name, int baud) {
  const Result<> opened = port.Open();
  if (!opened) Throw(opened.error(), DescribeSerialError(opened.error(), name, baud));
}

std::unique_ptr<hal::Camera> MakeCamera(const std::string& address, const CameraOptions& options,
                                        hal::Clock& clock) {
  if (address.starts_with(kLibcamera)) {
    auto config = LiveCamera<hal::libcamera::LibcameraConfig>(options);
    config.camera = Without(address, kLibcamera);
    return std::make_unique<hal::libcamera::LibcameraCamera>(std::move(config), clock);
  }
  if (address.starts_with(kV4l2)) {
    auto config = LiveCamera<hal::v4l2::V4l2Config>(options);
    config.device = Without(address, kV4l2);
    return std::make_unique<hal::v4l2::V4l2Camera>(std::move(config), clock);
  }
  return std::make_unique<hal::replay::ReplayCamera>(
      hal::replay::ReplayConfig{.path = Without(address, kReplay),
                                .pace = options.pace,
                                .loop = options.loop,
                                .memory_bytes = options.memory_bytes},
      clock);
}

std::string DescribeCameraError(Errc error, const hal::Camera& camera, const std::string& address) {
  // What stands behind the camera knows more than the code says.
  if (!camera.reason().empty()) {
    const bool lost = error == Errc::kNotFound && address.starts_with(kV4l2);
    return std::string(camera.reason()) +
           (lost ? "; `facewire doctor --cameras` lists those there are" : "");
  }
  const std::string name = Without(Without(address, kV4l2), kReplay);
  if (error == Errc::kTimeout) return name + " is silent: it sends no pictures";
  if (error == Errc::kEnd) return name + " is over";
  return name + ": " + Name(error);
}

void StartCamera(hal::Camera& camera, const std::string& address) {
  const Result<> started = camera.Start();
  if (!started) Throw(started.error(), DescribeCameraError(started.error(), camera, address));
}

}  // namespace facewire::app
