#include "hal/v4l2/camera_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>

#include "tests/hal/far_end.h"
#include "tests/hal/v4l2/fake_kernel.h"

namespace facewire::hal::v4l2 {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// A machine whose folders lie in a folder of the test's own, with one camera.
struct CameraListTest : public ::testing::Test {
  CameraListTest() {
    for (const char* folder : {"dev/v4l/by-id", "dev/v4l/by-path", "sys/video7", "proc/4711/fd"}) {
      fs::create_directories(folder_.File(folder));
    }
    Write("dev/video7", "");
    Write("sys/video7/name", "Fake Camera: as sysfs has it\n");
    kernel.node = folder_.File("dev/video7");
  }
  void Write(const std::string& file, const std::string& text) {
    std::ofstream(folder_.File(file)) << text;
  }
  void Link(const std::string& link, const std::string& target) {
    fs::create_symlink(target, folder_.File(link));
  }
  std::string Address(const std::string& file) const { return "v4l2:" + folder_.File(file); }
  std::vector<CameraInfo> List() {
    return ListCameras(kernel, {.dev = folder_.File("dev"),
                                .names = folder_.File("sys"),
                                .processes = folder_.File("proc")});
  }
  CameraInfo Only() {
    std::vector<CameraInfo> cameras = List();
    EXPECT_THAT(cameras, SizeIs(1));
    return cameras.empty() ? CameraInfo{} : cameras.front();
  }

  FakeKernel kernel;

 private:
  test::TemporaryFolder folder_;
};

TEST_F(CameraListTest, TellsFormatsSizesAndRates) {
  kernel.modes = {FakeKernel::Packed(V4L2_PIX_FMT_YUYV, 640, 480, 2),
                  FakeKernel::Mjpeg(1280, 720),
                  {.fourcc = V4L2_PIX_FMT_H264, .width = 1920, .height = 1080}};
  kernel.modes[0].rates = {30, 15};
  kernel.modes[1].rates = {60, 5};
  kernel.modes[1].range = true;
  const CameraInfo camera = Only();
  EXPECT_EQ(camera.name, "Fake Camera");
  EXPECT_EQ(camera.problem, std::nullopt);
  ASSERT_THAT(camera.modes, SizeIs(3));
  EXPECT_EQ(camera.modes[0].format, "yuyv");
  EXPECT_TRUE(camera.modes[0].readable);
  EXPECT_EQ(camera.modes[0].width_px, 640);
  EXPECT_EQ(camera.modes[0].height_px, 480);
  EXPECT_THAT(camera.modes[0].fps, ElementsAre(30, 15));
  EXPECT_FALSE(camera.modes[0].fps_range);
  EXPECT_EQ(camera.modes[1].format, "mjpeg");
  EXPECT_TRUE(camera.modes[1].fps_range);
  EXPECT_EQ(camera.modes[2].format, "H264");
  EXPECT_FALSE(camera.modes[2].readable);
  EXPECT_THAT(camera.modes[2].fps, IsEmpty());
  EXPECT_EQ(kernel.open_files(), 0);
}

TEST_F(CameraListTest, TheAddressIsTheMostStableLink) {
  EXPECT_EQ(Only().address, Address("dev/video7"));
  Link("dev/v4l/by-path/pci-usb-0:1:1.0-video-index0", "../../video7");
  EXPECT_EQ(Only().address, Address("dev/v4l/by-path/pci-usb-0:1:1.0-video-index0"));
  Link("dev/v4l/by-id/usb-Maker_Camera_123-video-index0", "../../video7");
  Link("dev/v4l/by-id/usb-Another", "../../video8");
  EXPECT_EQ(Only().address, Address("dev/v4l/by-id/usb-Maker_Camera_123-video-index0"));
  EXPECT_EQ(Only().node, kernel.node);
}

TEST_F(CameraListTest, LeavesOutWhatCapturesNoPictures) {
  for (const char* name : {"dev/video", "dev/video7x", "dev/vbi0", "dev/video8"}) Write(name, "");
  EXPECT_THAT(List(), SizeIs(1)) << "the kernel knows nothing of the others";
  kernel.device_caps = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_THAT(List(), IsEmpty());
  kernel.is_video_device = false;
  EXPECT_THAT(List(), IsEmpty());
}

TEST_F(CameraListTest, NamesACameraThatMayNotBeOpened) {
  kernel.open_error = EACCES;
  const CameraInfo camera = Only();
  EXPECT_EQ(camera.problem, Errc::kPermission);
  EXPECT_EQ(camera.name, "Fake Camera: as sysfs has it");
  EXPECT_EQ(camera.address, Address("dev/video7"));
}

TEST_F(CameraListTest, SaysWhoHoldsABusyOne) {
  kernel.buffers_error = EBUSY;
  EXPECT_EQ(Only().problem, Errc::kBusy);
  EXPECT_EQ(Only().holder, "");
  Write("proc/4711/comm", "cheese\n");
  Link("proc/4711/fd/0", "/dev/null");
  Link("proc/4711/fd/9", kernel.node);
  EXPECT_EQ(Only().holder, "cheese (process 4711)");
  EXPECT_THAT(Only().modes, SizeIs(1)) << "a camera in use still tells what it can do";
}

TEST_F(CameraListTest, AMachineWithoutCamerasHasNone) {
  EXPECT_THAT(
      ListCameras(kernel, {.dev = "/nowhere", .names = "/nowhere", .processes = "/nowhere"}),
      IsEmpty());
}

}  // namespace
}  // namespace facewire::hal::v4l2
