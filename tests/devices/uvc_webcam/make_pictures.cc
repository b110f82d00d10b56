// Pictures for uvc_webcam from a video: folders mjpeg-WxH and yuyv-WxH of numbered files.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace facewire::devices {
namespace {

constexpr int kJpegQuality = 85;  // some 40 kB at 640x480, as webcams send

struct Mode {
  std::string name;  // also the folder's
  bool jpeg = false;
  cv::Size size;
};

Mode ParseMode(const std::string& name) {
  Mode mode;
  mode.name = name;
  mode.jpeg = name.starts_with("mjpeg-");
  const std::size_t size = name.find('-') + 1;
  const char* const end = name.data() + name.size();
  const auto width = std::from_chars(name.data() + size, end, mode.size.width);
  if (width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, mode.size.height);
    const bool whole = height.ec == std::errc{} && height.ptr == end;
    const bool sane = mode.size.width > 0 && mode.size.width <= 4096 && mode.size.width % 2 == 0 &&
                      mode.size.height > 0 && mode.size.height <= 4096;
    if (whole && sane && (mode.jpeg || name.starts_with("yuyv-"))) return mode;
  }
  throw std::runtime_error("'" + name +
                           "' is no mode; give one such as mjpeg-640x480 or yuyv-640x480");
}

// The largest middle part of `picture` that has the shape asked for, scaled.
cv::Mat Fit(const cv::Mat& picture, cv::Size size) {
  const double scale = std::min(static_cast<double>(picture.cols) / size.width,
                                static_cast<double>(picture.rows) / size.height);
  const int width = static_cast<int>(size.width * scale);
  const int height = static_cast<int>(size.height * scale);
  const cv::Rect middle((picture.cols - width) / 2, (picture.rows - height) / 2, width, height);
  cv::Mat fitted;
  cv::resize(picture(middle), fitted, size, 0, 0, cv::INTER_LINEAR);
  return fitted;
}

// BT.601, limited range: what a UVC camera sends when it says nothing else.
std::vector<std::uint8_t> Yuyv(const cv::Mat& bgr) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(bgr.total() * 2);
  const auto component = [](double offset, double value) {
    return cv::saturate_cast<std::uint8_t>(offset + value);
  };
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; x += 2) {
      const auto& left = bgr.at<cv::Vec3b>(y, x);
      const auto& right = bgr.at<cv::Vec3b>(y, x + 1);
      const auto luma = [&](const cv::Vec3b& p) {
        return component(16, 0.098 * p[0] + 0.504 * p[1] + 0.257 * p[2]);
      };
      const cv::Vec3d mean = (cv::Vec3d(left) + cv::Vec3d(right)) / 2;
      bytes.push_back(luma(left));
      bytes.push_back(component(128, 0.439 * mean[0] - 0.291 * mean[1] - 0.148 * mean[2]));
      bytes.push_back(luma(right));
      bytes.push_back(component(128, -0.071 * mean[0] - 0.368 * mean[1] + 0.439 * mean[2]));
    }
  }
  return bytes;
}

void Write(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

void MakePictures(const std::string& video, const std::filesystem::path& folder, int first,
                  int count, const std::vector<std::string>& names) {
  std::vector<Mode> modes;
  for (const std::string& name : names) modes.push_back(ParseMode(name));
  cv::VideoCapture capture(video);
  if (!capture.isOpened()) throw std::runtime_error(video + " is not a video that can be read");
  for (const Mode& mode : modes) std::filesystem::create_directories(folder / mode.name);
  cv::Mat picture;
  for (int i = -first; i < count; ++i) {
    if (!capture.read(picture)) {
      throw std::runtime_error(video + " ends after " + std::to_string(i + first) + " pictures");
    }
    if (i < 0) continue;
    std::array<char, 16> number;
    std::snprintf(number.data(), number.size(), "%05d", i);
    for (const Mode& mode : modes) {
      const cv::Mat fitted = Fit(picture, mode.size);
      std::vector<std::uint8_t> bytes;
      if (mode.jpeg) {
        cv::imencode(".jpg", fitted, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
      } else {
        bytes = Yuyv(fitted);
      }
      Write(folder / mode.name / (number.data() + std::string(mode.jpeg ? ".jpg" : ".yuyv")),
            bytes);
    }
  }
}

}  // namespace
}  // namespace facewire::devices

int main(int argc, char** argv) {
  CLI::App app("Makes uvc_webcam's pictures from a video: FOLDER/MODE/00000.jpg and so on.");
  std::string video;
  std::string folder;
  std::vector<std::string> modes;
  int first = 0;
  int count = 240;
  app.add_option("video", video)->required();
  app.add_option("folder", folder)->required();
  app.add_option("modes", modes, "such as mjpeg-640x480 yuyv-640x480")->required();
  app.add_option("--first", first, "frames of the video that are left out before")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--count", count, "pictures of each mode")
      ->check(CLI::Range(1, 99999))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    facewire::devices::MakePictures(video, folder, first, count, modes);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_pictures: %s\n", error.what());
    return 2;
  }
  return 0;
}
