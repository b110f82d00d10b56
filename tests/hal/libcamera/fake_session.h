#ifndef FACEWIRE_TESTS_HAL_LIBCAMERA_FAKE_SESSION_H_
#define FACEWIRE_TESTS_HAL_LIBCAMERA_FAKE_SESSION_H_

#include <sys/mman.h>

#include <cstring>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "hal/libcamera/session.h"
#include "hal/posix/unique_fd.h"

namespace facewire::hal::libcamera {

// A camera of libcamera that does what a test says. The test stands in for libcamera's thread, too.
class FakeSession final : public Session {
 public:
  // What Open gives; set before Start.
  Errc refusal{};  // an error instead
  Negotiated negotiated = {.id = "/base/i2c/camera@10",
                           .model = "Fake",
                           .mode = {CameraFormat::kYuyv, 64, 48},
                           .fps = 30};
  std::vector<std::size_t> plane_bytes = {std::size_t{64} * 48 * 2};
  int buffer_count = 4;
  bool takes_buffers = true;

  Result<Negotiated> Open(const LibcameraConfig& /*config*/, HandOver& hand_over) override {
    if (refusal != Errc{}) return refusal;
    ++opened;
    open = true;
    hand_over_ = &hand_over;
    sequence_ = 0;
    for (int i = 0; i < buffer_count; ++i) {
      memory_.push_back(Memory());
      Result<MappedBuffer> mapped = MappedBuffer::Map(Extents(memory_.back().get()));
      if (!mapped) throw std::runtime_error("cannot map");
      buffers_.push_back(std::move(*mapped));
      queued.insert(i);
    }
    return negotiated;
  }
  std::span<const MappedBuffer> buffers() const override { return buffers_; }
  bool Queue(int buffer) override {
    if (!takes_buffers) return false;
    if (!queued.insert(buffer).second) throw std::logic_error("queued twice");
    return true;
  }
  void Close() override {
    open = false;
    buffers_.clear();
    memory_.clear();
    queued.clear();
  }
  const std::string& reason() const override { return reason_; }

  // The camera fills its next buffer with `value`, or writes `data` there.
  void Capture(std::uint8_t value, std::uint64_t stamp_ns = 0) {
    std::vector<std::uint8_t> data;
    for (const std::size_t bytes : plane_bytes) data.insert(data.end(), bytes, value);
    Capture(data, plane_bytes, stamp_ns);
  }
  void Capture(const std::vector<std::uint8_t>& data, const std::vector<std::size_t>& used,
               std::uint64_t stamp_ns = 0, bool whole = true) {
    if (queued.empty()) {  // nowhere to put it
      ++sequence_;
      return;
    }
    Completion completion;
    completion.buffer = *queued.begin();
    queued.erase(queued.begin());
    completion.whole = whole;
    completion.sequence = sequence_++;
    completion.stamp_ns = stamp_ns;
    for (std::size_t i = 0; i < used.size(); ++i) completion.bytes[i] = used[i];
    const int fd = memory_[static_cast<std::size_t>(completion.buffer)].get();
    if (::pwrite(fd, data.data(), data.size(), 0) != static_cast<ssize_t>(data.size())) {
      throw std::runtime_error("cannot write");
    }
    hand_over_->Push(completion);
  }
  void Skip(std::uint32_t count) { sequence_ += count; }
  void Unplug() { hand_over_->Lose(); }

  int opened = 0;
  bool open = false;
  std::set<int> queued;  // buffers that the camera may fill

 private:
  posix::UniqueFd Memory() const {
    posix::UniqueFd fd(::memfd_create("fake camera", MFD_CLOEXEC));
    std::size_t bytes = 0;
    for (const std::size_t plane : plane_bytes) bytes += plane;
    if (::ftruncate(fd.get(), static_cast<off_t>(bytes)) != 0)
      throw std::runtime_error("no memory");
    return fd;
  }
  std::vector<PlaneExtent> Extents(int fd) const {
    std::vector<PlaneExtent> extents;
    std::size_t offset = 0;
    for (const std::size_t bytes : plane_bytes) {
      extents.push_back({fd, offset, bytes});
      offset += bytes;
    }
    return extents;
  }

  std::vector<posix::UniqueFd> memory_;
  std::vector<MappedBuffer> buffers_;
  HandOver* hand_over_ = nullptr;
  std::uint32_t sequence_ = 0;
  std::string reason_ = "is not there";
};

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_TESTS_HAL_LIBCAMERA_FAKE_SESSION_H_
