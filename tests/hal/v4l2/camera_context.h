#ifndef FACEWIRE_TESTS_HAL_V4L2_CAMERA_CONTEXT_H_
#define FACEWIRE_TESTS_HAL_V4L2_CAMERA_CONTEXT_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hal/fake/fake_clock.h"
#include "hal/v4l2/v4l2_camera.h"
#include "tests/hal/v4l2/fake_kernel.h"

namespace facewire::hal::v4l2 {

constexpr std::chrono::milliseconds kWait{50};

// A camera on a kernel with one device.
struct V4l2CameraTest : public ::testing::Test {
  FakeKernel kernel;
  fake::FakeClock clock{Time{std::chrono::milliseconds(12345)}};
  V4l2Config config = {.device = FakeKernel::kPath};

  V4l2Camera Make() { return {config, clock, kernel}; }
  // The error of Start, with everything given back; its reason must say which device.
  Errc StartError(const std::string& says) {
    V4l2Camera camera = Make();
    const Result<> started = camera.Start();
    EXPECT_FALSE(started);
    EXPECT_THAT(camera.reason(), testing::HasSubstr(config.device + ": "));
    EXPECT_THAT(camera.reason(), testing::HasSubstr(says));
    EXPECT_EQ(kernel.open_files(), 0);
    EXPECT_EQ(kernel.maps(), 0);
    return started ? Errc{} : started.error();
  }
  // What a camera on this kernel negotiates.
  std::string Negotiated() {
    V4l2Camera camera = Make();
    const Result<> started = camera.Start();
    return started ? camera.Describe() : std::string(camera.reason());
  }
};

inline int Value(const Frame& frame) { return frame.image.planes[0].data[0]; }

}  // namespace facewire::hal::v4l2

#endif  // FACEWIRE_TESTS_HAL_V4L2_CAMERA_CONTEXT_H_
