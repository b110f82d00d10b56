// Everything that meets the library. It is written in what libcamera 0.0.3 (Debian 12) and 0.4
// (Debian 13, Raspberry Pi OS) have in common, so that no version macro is needed: roles are given
// as a braced list, which is a vector to the one and a span to the other; the orientation, which
// was called transform, stays as the camera has it.

#include <libcamera/libcamera.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "hal/libcamera/list.h"
#include "hal/libcamera/session.h"
#include "hal/posix/errors.h"

namespace facewire::hal::libcamera {
namespace {

namespace lc = ::libcamera;

struct Pair {
  CameraFormat format;
  lc::PixelFormat library;
};
// libcamera names packed colours as DRM does, from the highest byte to the lowest: RGB888 lies in
// memory as B, G, R.
constexpr Pair kPairs[] = {
    {CameraFormat::kYuyv, lc::formats::YUYV},    {CameraFormat::kNv12, lc::formats::NV12},
    {CameraFormat::kI420, lc::formats::YUV420},  {CameraFormat::kRgb24, lc::formats::BGR888},
    {CameraFormat::kBgr24, lc::formats::RGB888}, {CameraFormat::kMjpeg, lc::formats::MJPEG},
    {CameraFormat::kGrey8, lc::formats::R8},
};

std::optional<CameraFormat> FormatOf(const lc::PixelFormat& library) {
  for (const Pair& pair : kPairs) {
    if (pair.library == library) return pair.format;
  }
  return std::nullopt;
}

lc::PixelFormat LibraryFormatOf(CameraFormat format) {
  for (const Pair& pair : kPairs) {
    if (pair.format == format) return pair.library;
  }
  return {};
}

// libcamera tells its life to stderr, in the middle of what facewire says. It may where somebody
// asks for it with libcamera's own variables.
void QuietLog() {
  static std::once_flag once;
  std::call_once(once, [] {
    const bool wanted = std::getenv("LIBCAMERA_LOG_LEVELS") != nullptr ||
                        std::getenv("LIBCAMERA_LOG_FILE") != nullptr;
    if (!wanted) lc::logSetTarget(lc::LoggingTargetNone);
  });
}

// The library's manager of cameras, of which a program may have one at a time. Made anew for every
// session: it looks for cameras when it starts, so one that was plugged in again is found even
// where the system keeps its news of devices from us.
class Manager {
 public:
  Manager() : free_(!taken.exchange(true)) {
    if (!free_) return;
    QuietLog();
    manager_.emplace();
    started_ = manager_->start() == 0;
  }
  ~Manager() {
    if (!free_) return;
    manager_.reset();
    taken = false;
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  bool free() const { return free_; }
  std::vector<std::shared_ptr<lc::Camera>> cameras() const {
    if (!started_) return {};
    return manager_->cameras();
  }

 private:
  static std::atomic<bool> taken;
  bool free_;
  bool started_ = false;
  std::optional<lc::CameraManager> manager_;
};
std::atomic<bool> Manager::taken = false;

// libcamera is silent about devices that it may not open.
bool IsForbidden() {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
    const std::string name = entry.path().filename().string();
    const bool media = name.starts_with("media") || name.starts_with("video");
    if (media && ::access(entry.path().c_str(), R_OK | W_OK) != 0 && errno == EACCES) return true;
  }
  return false;
}

std::string ModelOf(const lc::Camera& camera) {
  const auto model = camera.properties().get(lc::properties::Model);
  return model ? std::string(*model) : std::string();
}

// `size` is one that the caller would like; offered, too, where the camera's sizes are free.
std::vector<Mode> ModesOf(const lc::StreamFormats& formats, std::optional<lc::Size> size) {
  std::vector<Mode> modes;
  for (const lc::PixelFormat& library : formats.pixelformats()) {
    const std::optional<CameraFormat> format = FormatOf(library);
    if (!format) continue;
    std::vector<lc::Size> sizes = formats.sizes(library);
    const lc::SizeRange range = formats.range(library);
    const bool steps = range.hStep > 0 && range.vStep > 0 && range.min != range.max;
    if (size && steps && range.contains(*size)) sizes.push_back(*size);
    for (const lc::Size& each : sizes) {
      modes.push_back({*format, static_cast<int>(each.width), static_cast<int>(each.height)});
    }
  }
  return modes;
}

class LibrarySession final : public Session {
 public:
  ~LibrarySession() override { LibrarySession::Close(); }

  Result<Negotiated> Open(const LibcameraConfig& config, HandOver& hand_over) override;
  std::span<const MappedBuffer> buffers() const override { return buffers_; }
  bool Queue(int buffer) override;
  void Close() override;
  const std::string& reason() const override { return reason_; }

 private:
  Errc Fail(Errc code, std::string why) {
    reason_ = std::move(why);
    return code;
  }
  Result<> Find(const std::string& address);
  Result<> Acquire();
  Result<> Configure(const LibcameraConfig& config);
  Result<> ChooseRate(const LibcameraConfig& config, lc::ControlList& controls);
  Result<> MapBuffers();
  Result<> Stream(const lc::ControlList& controls);
  void Completed(lc::Request* request);
  void Disconnected() { hand_over_->Lose(); }

  std::optional<Manager> manager_;
  std::shared_ptr<lc::Camera> camera_;
  std::unique_ptr<lc::CameraConfiguration> configuration_;
  std::unique_ptr<lc::FrameBufferAllocator> allocator_;
  std::vector<MappedBuffer> buffers_;
  std::vector<std::unique_ptr<lc::Request>> requests_;  // one for each buffer
  HandOver* hand_over_ = nullptr;
  Negotiated negotiated_;
  std::string reason_;
};

Result<Negotiated> LibrarySession::Open(const LibcameraConfig& config, HandOver& hand_over) {
  Close();
  hand_over_ = &hand_over;
  negotiated_ = {};
  Result<> done = Find(config.camera);
  if (done) done = Acquire();
  if (done) done = Configure(config);
  lc::ControlList controls;
  if (done) {
    controls = lc::ControlList(camera_->controls());
    done = ChooseRate(config, controls);
  }
  if (done) done = MapBuffers();
  if (done) done = Stream(controls);
  if (!done) {
    Close();
    return done.error();
  }
  return negotiated_;
}

Result<> LibrarySession::Find(const std::string& address) {
  manager_.emplace();
  if (!manager_->free()) {
    return Fail(Errc::kBusy, "this program uses libcamera already, and it can do so only once");
  }
  const auto cameras = manager_->cameras();
  std::size_t index = 0;
  const char* const end = address.data() + address.size();
  const auto number = std::from_chars(address.data(), end, index);
  const bool numbered = number.ec == std::errc{} && number.ptr == end;
  if (numbered && index < cameras.size()) camera_ = cameras[index];
  for (const auto& camera : cameras) {
    if (camera->id() == address) camera_ = camera;
  }
  if (camera_) return {};
  if (cameras.empty()) {
    if (IsForbidden()) {
      return Fail(Errc::kPermission, "no permission: the user must be in the group 'video'");
    }
    return Fail(Errc::kNotFound, "libcamera finds no camera; is it plugged in?");
  }
  std::string there;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    there += (i == 0 ? "" : ", ") + std::to_string(i) + ": " + cameras[i]->id();
  }
  return Fail(Errc::kNotFound, "there is no such camera; libcamera has " + there);
}

Result<> LibrarySession::Acquire() {
  negotiated_.id = camera_->id();
  negotiated_.model = ModelOf(*camera_);
  const int result = camera_->acquire();
  if (result == 0) return {};
  const Errc code = posix::OpenError(-result);
  return Fail(code, code == Errc::kBusy
                        ? "another program is using the camera"
                        : std::string("cannot be acquired: ") + std::strerror(-result));
}

Result<> LibrarySession::Configure(const LibcameraConfig& config) {
  configuration_ = camera_->generateConfiguration({lc::StreamRole::Viewfinder});
  if (!configuration_ || configuration_->empty()) {
    return Fail(Errc::kUnsupported, "has no stream for a viewfinder");
  }
  lc::StreamConfiguration& stream = configuration_->at(0);
  const lc::Size size(static_cast<unsigned>(config.width_px),
                      static_cast<unsigned>(config.height_px));
  const std::vector<Mode> modes = ModesOf(stream.formats(), size);
  const std::optional<Mode> mode =
      ChooseMode(modes, config.formats, config.width_px, config.height_px);
  if (!mode) {
    std::string offered;
    for (const lc::PixelFormat& format : stream.formats().pixelformats()) {
      offered += (offered.empty() ? "" : ", ") + format.toString();
    }
    std::string wanted;
    for (const CameraFormat format : config.formats) {
      wanted += (wanted.empty() ? "" : ", ") + std::string(Name(format));
    }
    return Fail(Errc::kUnsupported, "offers only " + (offered.empty() ? "no format" : offered) +
                                        "; one of " + wanted + " is needed");
  }
  stream.pixelFormat = LibraryFormatOf(mode->format);
  stream.size = {static_cast<unsigned>(mode->width_px), static_cast<unsigned>(mode->height_px)};
  stream.bufferCount = static_cast<unsigned>(config.buffer_count);
  const bool valid = configuration_->validate() != lc::CameraConfiguration::Invalid;
  const std::optional<CameraFormat> format = FormatOf(stream.pixelFormat);
  if (!valid || !format) return Fail(Errc::kUnsupported, "refuses " + Describe(*mode));
  if (const int result = camera_->configure(configuration_.get()); result != 0) {
    return Fail(posix::OpenError(-result), result == -EBUSY
                                               ? "another program is using the camera"
                                               : "cannot be set to " + stream.toString());
  }
  negotiated_.mode = {*format, static_cast<int>(stream.size.width),
                      static_cast<int>(stream.size.height)};
  negotiated_.stride_bytes = stream.stride;
  const bool full = stream.colorSpace && stream.colorSpace->range == lc::ColorSpace::Range::Full;
  negotiated_.yuv = full ? YuvEncoding::kBt601Full : YuvEncoding::kBt601Limited;
  return {};
}

// A camera without this control (a USB webcam's driver, for libcamera) runs at its own rate.
Result<> LibrarySession::ChooseRate(const LibcameraConfig& config, lc::ControlList& controls) {
  const auto limits = camera_->controls().find(&lc::controls::FrameDurationLimits);
  if (limits == camera_->controls().end()) return {};
  const lc::ControlValue& shortest = limits->second.min();
  const lc::ControlValue& longest = limits->second.max();
  for (const lc::ControlValue* value : {&shortest, &longest}) {
    if (value->type() != lc::ControlTypeInteger64 || value->isArray()) return {};
  }
  const std::int64_t us =
      ChooseFrameDuration(config.fps, shortest.get<std::int64_t>(), longest.get<std::int64_t>());
  if (us <= 0) return {};
  negotiated_.fps = 1e6 / static_cast<double>(us);
  if (negotiated_.fps < config.lowest_fps) {
    return Fail(Errc::kUnsupported, "runs at " + std::to_string(negotiated_.fps) + " fps at " +
                                        Describe(negotiated_.mode) + "; ask for a smaller picture");
  }
  controls.set(lc::controls::FrameDurationLimits, {us, us});
  return {};
}

Result<> LibrarySession::MapBuffers() {
  lc::Stream* const stream = configuration_->at(0).stream();
  allocator_ = std::make_unique<lc::FrameBufferAllocator>(camera_);
  if (const int count = allocator_->allocate(stream); count <= 0) {
    return Fail(
        count == -EBUSY ? Errc::kBusy : Errc::kIo,
        count == -EBUSY ? "another program is using the camera" : "gives no memory for pictures");
  }
  for (const auto& buffer : allocator_->buffers(stream)) {
    if (buffers_.size() == kMaxBuffers) break;
    std::vector<PlaneExtent> planes;
    for (const lc::FrameBuffer::Plane& plane : buffer->planes()) {
      planes.push_back({plane.fd.get(), plane.offset, plane.length});
    }
    Result<MappedBuffer> mapped = MappedBuffer::Map(planes);
    std::unique_ptr<lc::Request> request = camera_->createRequest(buffers_.size());
    if (!mapped || !request || request->addBuffer(stream, buffer.get()) != 0) {
      return Fail(Errc::kIo, "gives memory for pictures that cannot be used");
    }
    buffers_.push_back(std::move(*mapped));
    requests_.push_back(std::move(request));
  }
  return {};
}

Result<> LibrarySession::Stream(const lc::ControlList& controls) {
  camera_->requestCompleted.connect(this, &LibrarySession::Completed);
  camera_->disconnected.connect(this, &LibrarySession::Disconnected);
  int result = camera_->start(&controls);
  for (std::size_t i = 0; i < requests_.size() && result == 0; ++i) {
    result = camera_->queueRequest(requests_[i].get());
  }
  if (result == 0) return {};
  const Errc code = posix::OpenError(-result);
  return Fail(code, code == Errc::kBusy
                        ? "another program is using the camera"
                        : std::string("does not start its stream: ") + std::strerror(-result));
}

// On libcamera's thread.
void LibrarySession::Completed(lc::Request* request) {
  // Cancelled: the stream is being stopped, or the camera has gone, which is told separately.
  if (request->status() != lc::Request::RequestComplete) return;
  const lc::FrameMetadata& metadata = request->buffers().begin()->second->metadata();
  Completion completion;
  completion.buffer = static_cast<int>(request->cookie());
  completion.whole = metadata.status == lc::FrameMetadata::FrameSuccess;
  completion.sequence = metadata.sequence;
  // The time of the sensor where the camera tells it, else when the picture was in memory.
  completion.stamp_ns =
      static_cast<std::uint64_t>(request->metadata()
                                     .get(lc::controls::SensorTimestamp)
                                     .value_or(static_cast<std::int64_t>(metadata.timestamp)));
  std::size_t i = 0;
  for (const lc::FrameMetadata::Plane& plane : metadata.planes()) {
    if (i < completion.bytes.size()) completion.bytes[i++] = plane.bytesused;
  }
  hand_over_->Push(completion);
}

bool LibrarySession::Queue(int buffer) {
  lc::Request& request = *requests_[static_cast<std::size_t>(buffer)];
  request.reuse(lc::Request::ReuseBuffers);
  return camera_->queueRequest(&request) == 0;
}

void LibrarySession::Close() {
  if (camera_) {
    camera_->stop();
    camera_->requestCompleted.disconnect(this);
    camera_->disconnected.disconnect(this);
    // On libcamera's thread, and waiting for it: a camera that was pulled out is not stopped, and
    // requests that were on their way to it must have arrived before they are destroyed.
    camera_->invokeMethod(&lc::Camera::release, lc::ConnectionTypeBlocking);
  }
  // In this order: requests name buffers and the camera, and the manager waits for none of them.
  buffers_.clear();
  requests_.clear();
  allocator_.reset();
  configuration_.reset();
  camera_.reset();
  manager_.reset();
}

}  // namespace

std::unique_ptr<Session> MakeLibrarySession() { return std::make_unique<LibrarySession>(); }

std::vector<CameraInfo> ListCameras() {
  std::vector<CameraInfo> listed;
  const Manager manager;
  if (!manager.free()) return listed;
  for (const auto& camera : manager.cameras()) {
    CameraInfo& info = listed.emplace_back();
    info.address = "libcamera:" + camera->id();
    info.name = ModelOf(*camera);
    const auto configuration = camera->generateConfiguration({lc::StreamRole::Viewfinder});
    if (!configuration || configuration->empty()) continue;
    for (const Mode& mode : ModesOf(configuration->at(0).formats(), std::nullopt)) {
      info.modes.push_back({.format = std::string(Name(mode.format)),
                            .readable = true,
                            .width_px = mode.width_px,
                            .height_px = mode.height_px});
    }
  }
  return listed;
}

}  // namespace facewire::hal::libcamera
