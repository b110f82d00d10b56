#include "tools/facewire/camera_report.h"

#include <gtest/gtest.h>

namespace facewire::tools {
namespace {

hal::CameraInfo Webcam() {
  hal::CameraInfo camera;
  camera.address = "v4l2:/dev/v4l/by-id/usb-Maker_Webcam-video-index0";
  camera.node = "/dev/video0";
  camera.name = "A \"good\" Webcam";
  camera.modes = {
      {.format = "yuyv", .readable = true, .width_px = 640, .height_px = 480, .fps = {30, 29.97}},
      {.format = "mjpeg",
       .readable = true,
       .width_px = 1280,
       .height_px = 720,
       .fps = {60, 5},
       .fps_range = true},
      {.format = "H264"}};
  return camera;
}

TEST(CameraReport, TheTableHasTheLineForTheConfiguration) {
  EXPECT_EQ(CameraTable({Webcam()}),
            "A \"good\" Webcam (now /dev/video0)\n"
            "  device = \"v4l2:/dev/v4l/by-id/usb-Maker_Webcam-video-index0\"\n"
            "  yuyv   640x480    30, 29.97 fps\n"
            "  mjpeg  1280x720   60 down to 5 fps\n"
            "  H264   any size   rate not listed  (not read by facewire)\n");
  EXPECT_EQ(CameraTable({}), "");
}

TEST(CameraReport, EachProblemHasItsFix) {
  hal::CameraInfo camera = Webcam();
  EXPECT_EQ(ProblemOf(camera), "");
  EXPECT_EQ(FixOf(camera), "");
  camera.problem = Errc::kPermission;
  EXPECT_EQ(ProblemOf(camera), "no permission");
  EXPECT_EQ(FixOf(camera), "sudo usermod -aG video $USER, then log in again");
  camera.problem = Errc::kBusy;
  EXPECT_EQ(ProblemOf(camera), "in use by another program");
  camera.holder = "cheese (process 4711)";
  EXPECT_EQ(ProblemOf(camera), "in use by cheese (process 4711)");
  EXPECT_NE(CameraTable({camera}).find("  in use by cheese (process 4711)\n  -> end that program"),
            std::string::npos);
  camera.problem = Errc::kIo;
  EXPECT_EQ(ProblemOf(camera), "cannot be opened");
  EXPECT_NE(FixOf(camera), "");
  camera = Webcam();
  camera.modes = {{.format = "H264"}};
  EXPECT_EQ(ProblemOf(camera), "has no format that facewire reads");
  EXPECT_NE(FixOf(camera), "");
}

TEST(CameraReport, JsonIsAnObjectALine) {
  hal::CameraInfo camera = Webcam();
  camera.modes.pop_back();
  const std::string line =
      R"({"address":"v4l2:/dev/v4l/by-id/usb-Maker_Webcam-video-index0","node":"/dev/video0",)"
      R"("name":"A \"good\" Webcam","problem":"","fix":"","modes":[)"
      R"({"format":"yuyv","readable":true,"width_px":640,"height_px":480,"fps":[30,29.97],)"
      R"("fps_range":false},{"format":"mjpeg","readable":true,"width_px":1280,"height_px":720,)"
      R"("fps":[60,5],"fps_range":true}]})"
      "\n";
  EXPECT_EQ(CameraJson({camera, camera}), line + line);
}

}  // namespace
}  // namespace facewire::tools
