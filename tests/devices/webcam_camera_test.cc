// Both camera backends on a USB webcam: the kernel's own driver, the plug, and pictures that are
// known byte for byte.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <ostream>
#include <thread>

#include "hal/jpeg/jpeg_decoder.h"
#include "hal/libcamera/libcamera_camera.h"
#include "hal/libcamera/list.h"
#include "hal/system_clock.h"
#include "hal/v4l2/v4l2_camera.h"
#include "tests/devices/webcam.h"

namespace facewire::devices {
namespace {

using hal::CameraFormat;
using hal::libcamera::LibcameraCamera;
using hal::libcamera::LibcameraConfig;
using hal::v4l2::V4l2Camera;
using hal::v4l2::V4l2Config;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kAmple{20'000};

struct Backend {
  const char* name;
  std::function<std::unique_ptr<hal::Camera>(hal::Clock&, std::vector<CameraFormat>)> make;
};

std::unique_ptr<hal::Camera> MakeV4l2(hal::Clock& clock, std::vector<CameraFormat> formats) {
  V4l2Config config;
  config.device = kWebcamById;
  config.formats = std::move(formats);
  return std::make_unique<V4l2Camera>(std::move(config), clock);
}

std::unique_ptr<hal::Camera> MakeLibcamera(hal::Clock& clock, std::vector<CameraFormat> formats) {
  LibcameraConfig config;
  config.formats = std::move(formats);
  return std::make_unique<LibcameraCamera>(std::move(config), clock);
}

void PrintTo(const Backend& backend, std::ostream* out) { *out << backend.name; }

// Frame::seq against the pictures that the camera shows one after the other, over and over.
class Matcher {
 public:
  Matcher(std::size_t count, std::function<bool(const ImageView&, std::size_t)> same)
      : count_(count), same_(std::move(same)) {}

  // Whether the frame is a picture of the camera; and after the first frame, the one that its
  // number says. (libcamera starts the stream before it gives buffers: some pictures are lost
  // before frame 0.)
  bool IsWhatWasSent(const Frame& frame) {
    for (; !first_ && begin_ < count_; ++begin_) {
      if (same_(frame.image, begin_)) first_ = frame.seq;
      if (first_) break;
    }
    return first_ && same_(frame.image, (begin_ + frame.seq - *first_) % count_);
  }

 private:
  std::size_t count_;
  std::function<bool(const ImageView&, std::size_t)> same_;
  std::size_t begin_ = 0;  // the picture of the first frame
  std::optional<std::uint64_t> first_;
};

bool IsRaw(const ImageView& seen, const std::vector<std::uint8_t>& sent) {
  return seen.planes[0].stride_bytes == 1280 &&
         std::memcmp(seen.planes[0].data, sent.data(), sent.size()) == 0;
}

class WebcamTest : public ::testing::TestWithParam<Backend> {
 protected:
  void SetUp() override { webcam.Reset(); }
  std::unique_ptr<hal::Camera> Make(CameraFormat format = CameraFormat::kMjpeg) {
    return GetParam().make(clock, {format});
  }
  // The first failure, while every frame goes back; {} when `limit` frames came before.
  static Errc UntilFailure(hal::Camera& camera, int limit = 300) {
    for (int i = 0; i < limit; ++i) {
      const Result<Frame> frame = camera.Acquire(kAmple);
      if (!frame) return frame.error();
      camera.Release(*frame);
    }
    return {};
  }
  // After plugging in: the kernel and udev take their time, and a service tries again, too.
  static void StartAgain(hal::Camera& camera) {
    WaitUntil("the camera to start", [&] {
      const Result<> started = camera.Start();
      EXPECT_TRUE(started || started.error() == Errc::kNotFound) << camera.reason();
      return started.has_value();
    });
  }
  static void ExpectFrames(hal::Camera& camera, int count = 5) {
    for (int i = 0; i < count; ++i) {
      const Result<Frame> frame = camera.Acquire(kAmple);
      ASSERT_TRUE(frame) << Name(frame.error()) << " " << camera.reason();
      camera.Release(*frame);
    }
  }

  hal::SystemClock clock;
  Webcam webcam;
};

INSTANTIATE_TEST_SUITE_P(Backends, WebcamTest,
                         ::testing::Values(Backend{"V4l2", MakeV4l2},
                                           Backend{"libcamera", MakeLibcamera}),
                         [](const auto& row) { return std::string(row.param.name); });

TEST_P(WebcamTest, JpegsAreDecodedToThePicturesThatWereSent) {
  const auto files = Webcam::Pictures("mjpeg-640x480");
  hal::jpeg::JpegDecoder decoder(640, 480);
  const std::unique_ptr<hal::Camera> camera = Make();
  StartAgain(*camera);
  Matcher matcher(files.size(), [&](const ImageView& seen, std::size_t i) {
    const Result<ImageView> sent = decoder.Decode(files[i]);
    return sent && seen.format == sent->format && seen.width_px == 640 && seen.height_px == 480 &&
           std::memcmp(seen.planes[0].data, sent->planes[0].data, 640 * 480 * 3) == 0;
  });
  for (int i = 0; i < 10; ++i) {
    const Result<Frame> frame = camera->Acquire(kAmple);
    ASSERT_TRUE(frame) << camera->reason();
    EXPECT_TRUE(matcher.IsWhatWasSent(*frame)) << "frame " << frame->seq;
    camera->Release(*frame);
  }
  EXPECT_EQ(camera->counts().damaged, 0U);
}

TEST_P(WebcamTest, RawPicturesAreThoseThatWereSent) {
  const auto files = Webcam::Pictures("yuyv-640x480");
  const std::unique_ptr<hal::Camera> camera = Make(CameraFormat::kYuyv);
  StartAgain(*camera);
  Matcher matcher(files.size(),
                  [&](const ImageView& seen, std::size_t i) { return IsRaw(seen, files[i]); });
  for (int i = 0; i < 10; ++i) {
    const Result<Frame> frame = camera->Acquire(kAmple);
    ASSERT_TRUE(frame) << camera->reason();
    EXPECT_TRUE(matcher.IsWhatWasSent(*frame)) << "frame " << frame->seq;
    camera->Release(*frame);
  }
}

TEST_P(WebcamTest, FramesRiseInNumberAndTimeAtTheCamerasRate) {
  const std::unique_ptr<hal::Camera> camera = Make(CameraFormat::kYuyv);
  StartAgain(*camera);
  Frame first;
  Frame last;
  for (int i = 0; i < 90; ++i) {
    const Result<Frame> frame = camera->Acquire(kAmple);
    ASSERT_TRUE(frame) << camera->reason();
    const Duration age = clock.Now() - frame->captured;
    EXPECT_GE(age, Duration::zero());
    EXPECT_LT(age, seconds(5));  // of an emulated processor that has other things to do, too
    if (i == 0) {
      first = *frame;
    } else {
      EXPECT_GT(frame->seq, last.seq);
      EXPECT_GT(frame->captured, last.captured);
    }
    last = *frame;
    camera->Release(*frame);
  }
  const double passed = 1e-6 * static_cast<double>((last.captured - first.captured).count());
  const double fps = static_cast<double>(last.seq - first.seq) / passed;
  std::printf("%s: %.2f fps, %d of %d pictures taken\n", GetParam().name, fps, 90,
              static_cast<int>(last.seq - first.seq) + 1);
  EXPECT_LT(fps, 31);  // an emulated processor may be slower, and then the camera waits for it
  EXPECT_GT(fps, 3);
}

TEST_P(WebcamTest, BrokenJpegsAreDroppedAndCounted) {
  const std::unique_ptr<hal::Camera> camera = Make();
  StartAgain(*camera);
  ExpectFrames(*camera, 1);
  // Slow enough that none of them is overtaken, once the quick ones before are through.
  webcam.Tell("rate 2");
  ExpectFrames(*camera, 4);
  webcam.Tell("damage 3");
  ExpectFrames(*camera, 5);
  EXPECT_EQ(camera->counts().damaged, 3U);
}

TEST_P(WebcamTest, ASilentCameraIsATimeoutAndGoesOn) {
  const std::unique_ptr<hal::Camera> camera = Make();
  StartAgain(*camera);
  ExpectFrames(*camera);
  webcam.Tell("stall");
  Errc failure{};
  for (int i = 0; i < 20 && failure == Errc{}; ++i) {
    const Result<Frame> frame = camera->Acquire(milliseconds(500));
    if (frame) camera->Release(*frame);
    if (!frame) failure = frame.error();
  }
  EXPECT_EQ(failure, Errc::kTimeout);
  webcam.Tell("resume");
  ExpectFrames(*camera);
  webcam.Tell("stall");
  camera->Stop();
  webcam.Tell("resume");
  StartAgain(*camera);
  ExpectFrames(*camera);
}

TEST_P(WebcamTest, ACameraPulledOutInMidStreamIsGoneUntilItIsBack) {
  const std::unique_ptr<hal::Camera> camera = Make();
  for (int round = 0; round < 3; ++round) {
    StartAgain(*camera);
    ExpectFrames(*camera);
    webcam.Unplug();
    EXPECT_EQ(UntilFailure(*camera), Errc::kDisconnected) << camera->reason();
    EXPECT_FALSE(camera->reason().empty());
    EXPECT_EQ(camera->Start().error(), Errc::kNotFound) << camera->reason();
    webcam.Plug();
  }
  StartAgain(*camera);
  ExpectFrames(*camera);
}

TEST_P(WebcamTest, PullingTheCameraOutEndsAWait) {
  const std::unique_ptr<hal::Camera> camera = Make();
  StartAgain(*camera);
  ExpectFrames(*camera);
  webcam.Tell("stall");
  std::thread hand([&] {
    std::this_thread::sleep_for(milliseconds(200));
    webcam.Unplug();
  });
  const Time before = clock.Now();
  const Errc failure = UntilFailure(*camera);
  const Duration waited = clock.Now() - before;
  hand.join();
  EXPECT_EQ(failure, Errc::kDisconnected);
  EXPECT_LT(waited, seconds(10));
}

TEST_P(WebcamTest, AFrameHeldWhileTheCameraIsPulledOutStaysReadable) {
  const auto files = Webcam::Pictures("yuyv-640x480");
  const std::unique_ptr<hal::Camera> camera = Make(CameraFormat::kYuyv);
  StartAgain(*camera);
  const Result<Frame> held = camera->Acquire(kAmple);
  ASSERT_TRUE(held);
  webcam.Unplug();
  EXPECT_TRUE(std::any_of(files.begin(), files.end(),
                          [&](const auto& file) { return IsRaw(held->image, file); }));
  camera->Release(*held);
  EXPECT_EQ(UntilFailure(*camera), Errc::kDisconnected);
}

TEST_P(WebcamTest, ASecondOpenerIsBusyAndDoesNotDisturbTheFirst) {
  const std::unique_ptr<hal::Camera> first = Make();
  StartAgain(*first);
  ExpectFrames(*first);
  const std::unique_ptr<hal::Camera> second = Make();
  EXPECT_EQ(second->Start().error(), Errc::kBusy);
  EXPECT_FALSE(second->reason().empty());
  ExpectFrames(*first);
  first->Stop();
  EXPECT_TRUE(second->Start()) << second->reason();
}

TEST_P(WebcamTest, LeavesNoFileOpen) {
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  };
  const std::unique_ptr<hal::Camera> camera = Make();
  StartAgain(*camera);
  camera->Stop();
  const auto before = open_files();
  for (int round = 0; round < 5; ++round) {
    StartAgain(*camera);
    const Result<Frame> frame = camera->Acquire(kAmple);
    ASSERT_TRUE(frame) << camera->reason();
    if (round % 2 == 0) camera->Release(*frame);  // stopping takes back one that is still out
    camera->Stop();
  }
  EXPECT_EQ(open_files(), before);
  StartAgain(*camera);
  webcam.Unplug();
  EXPECT_EQ(UntilFailure(*camera), Errc::kDisconnected);
  EXPECT_EQ(open_files(), before);
}

TEST(WebcamLibcamera, IsListedWithWhatItCanDoAndFoundByItsId) {
  Webcam webcam;
  webcam.Reset();
  const std::vector<hal::CameraInfo> cameras = hal::libcamera::ListCameras();
  ASSERT_EQ(cameras.size(), 1U);  // vivid is none for libcamera
  const hal::CameraInfo& listed = cameras.front();
  std::printf("%s: %s\n", listed.address.c_str(), listed.name.c_str());
  EXPECT_NE(listed.name.find(kWebcamName), std::string::npos);
  EXPECT_TRUE(std::any_of(listed.modes.begin(), listed.modes.end(), [](const auto& mode) {
    return mode.format == "mjpeg" && mode.width_px == 1280 && mode.height_px == 720;
  }));
  const std::string id = listed.address.substr(std::string("libcamera:").size());
  hal::SystemClock clock;
  LibcameraConfig config;
  config.camera = id;
  config.width_px = 1280;
  config.height_px = 720;
  LibcameraCamera camera(config, clock);
  ASSERT_TRUE(camera.Start()) << camera.reason();
  const Result<Frame> frame = camera.Acquire(kAmple);
  ASSERT_TRUE(frame) << camera.reason();
  EXPECT_EQ(frame->image.width_px, 1280);
  EXPECT_TRUE(hal::libcamera::ListCameras().empty());  // one at a time
  config.camera = "1";
  camera.Stop();
  LibcameraCamera missing(config, clock);
  EXPECT_EQ(missing.Start().error(), Errc::kNotFound);
  EXPECT_NE(missing.reason().find("0: " + id), std::string_view::npos) << missing.reason();
}

}  // namespace
}  // namespace facewire::devices
