#include "tests/support/footage.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/videoio.hpp>
#include <stdexcept>

namespace facewire::test {
namespace {

std::string Asset(const std::string& folder, const std::string& name) {
  std::string path = std::string(FACEWIRE_ASSETS) + "/" + folder + "/" + name;
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(path + " is missing; tools/setup fetches it");
  }
  return path;
}

struct PlaneSize {
  int row_bytes, rows;
};

std::vector<PlaneSize> PlaneSizes(PixelFormat format, int width, int height) {
  const int half_w = (width + 1) / 2;
  const int half_h = (height + 1) / 2;
  switch (format) {
    case PixelFormat::kGrey8:
      return {{width, height}};
    case PixelFormat::kYuyv:
      return {{4 * half_w, height}};
    case PixelFormat::kNv12:
      return {{width, height}, {2 * half_w, half_h}};
    case PixelFormat::kI420:
      return {{width, height}, {half_w, half_h}, {half_w, half_h}};
    case PixelFormat::kRgb24:
    case PixelFormat::kBgr24:
      return {{3 * width, height}};
  }
  throw std::logic_error("no such format");
}

std::uint8_t ToByte(double v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 255.0)));
}

struct Yuv {
  double y, u, v;
};

// The forward direction of BT.601, from its luma weights 0.299, 0.587, 0.114.
Yuv ToYuv(const std::uint8_t* bgr, YuvEncoding encoding) {
  const double y = 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];
  const double u = (bgr[0] - y) / 1.772;
  const double v = (bgr[2] - y) / 1.402;
  if (encoding == YuvEncoding::kBt601Full) return {y, u + 128, v + 128};
  return {y * 219 / 255 + 16, u * 224 / 255 + 128, v * 224 / 255 + 128};
}

// Of a picture with three bytes a pixel.
const std::uint8_t* PixelAt(const ImageView& image, std::ptrdiff_t x, std::ptrdiff_t y) {
  return image.planes[0].data + y * image.planes[0].stride_bytes + 3 * x;
}

// Mean over the part of a block that is in the picture.
Yuv MeanYuv(const Picture& bgr, int x, int y, int width, int height, YuvEncoding encoding) {
  Yuv sum{};
  int n = 0;
  const ImageView& image = bgr.view();
  for (int j = y; j < std::min(y + height, image.height_px); ++j) {
    for (int i = x; i < std::min(x + width, image.width_px); ++i, ++n) {
      const Yuv one = ToYuv(PixelAt(image, i, j), encoding);
      sum = {sum.y + one.y, sum.u + one.u, sum.v + one.v};
    }
  }
  return {sum.y / n, sum.u / n, sum.v / n};
}

}  // namespace

std::vector<std::byte> ReadNetwork(const std::string& name) {
  const std::string path = Asset("networks", name);
  std::vector<std::byte> bytes(std::filesystem::file_size(path));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

NetworkBytes::NetworkBytes(track::Model model)
    : detector(ReadNetwork("face_detection_short_range.tflite")),
      landmarks(ReadNetwork(model == track::Model::kAttention
                                ? "face_landmark_with_attention.tflite"
                                : "face_landmark.tflite")) {}

Picture::Picture(PixelFormat format, int width, int height, int padding, YuvEncoding encoding) {
  view_ = {.format = format, .encoding = encoding, .width_px = width, .height_px = height};
  const bool yuv = format != PixelFormat::kGrey8 && format != PixelFormat::kRgb24 &&
                   format != PixelFormat::kBgr24;
  const auto sizes = PlaneSizes(format, width, height);
  for (std::size_t p = 0; p < sizes.size(); ++p) {
    const int stride = sizes[p].row_bytes + padding;
    // No padding behind the last row, so that the address sanitizer sees a read beyond it.
    pixels_.emplace_back(static_cast<std::size_t>(stride) * sizes[p].rows - padding, 0xcd);
    view_.planes[p] = {pixels_[p].data(), stride};
    for (int y = 0; y < sizes[p].rows; ++y) {
      std::uint8_t black = 0;
      if (yuv) black = p > 0 ? 128 : (encoding == YuvEncoding::kBt601Full ? 0 : 16);
      std::memset(row(p, y), black, static_cast<std::size_t>(sizes[p].row_bytes));
      if (format != PixelFormat::kYuyv) continue;
      for (int i = 1; i < sizes[p].row_bytes; i += 2) row(p, y)[i] = 128;
    }
  }
}

std::uint8_t* Picture::row(std::size_t plane, int y) {
  return pixels_[plane].data() + static_cast<std::ptrdiff_t>(y) * view_.planes[plane].stride_bytes;
}

Picture Picture::As(PixelFormat format, int padding, YuvEncoding encoding) const {
  const int width = view_.width_px;
  const int height = view_.height_px;
  Picture out(format, width, height, padding, encoding);
  const int block_h = format == PixelFormat::kYuyv ? 1 : 2;
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* from = PixelAt(view_, 0, y);
    std::uint8_t* to = out.row(0, y);
    for (int x = 0; x < width; ++x, from += 3) {
      switch (format) {
        case PixelFormat::kBgr24:
          std::copy_n(from, 3, to + std::ptrdiff_t{3} * x);
          break;
        case PixelFormat::kRgb24:
          std::reverse_copy(from, from + 3, to + std::ptrdiff_t{3} * x);
          break;
        case PixelFormat::kGrey8:
          to[x] = ToByte(ToYuv(from, YuvEncoding::kBt601Full).y);
          break;
        case PixelFormat::kYuyv:
          to[std::ptrdiff_t{2} * x] = ToByte(ToYuv(from, encoding).y);
          break;
        case PixelFormat::kNv12:
        case PixelFormat::kI420:
          to[x] = ToByte(ToYuv(from, encoding).y);
          break;
      }
      if (x % 2 != 0 || y % block_h != 0) continue;
      const Yuv mean = MeanYuv(*this, x, y, 2, block_h, encoding);
      if (format == PixelFormat::kYuyv) {
        to[std::ptrdiff_t{2} * x + 1] = ToByte(mean.u);
        to[std::ptrdiff_t{2} * x + 3] = ToByte(mean.v);
      } else if (format == PixelFormat::kNv12) {
        out.row(1, y / 2)[x] = ToByte(mean.u);
        out.row(1, y / 2)[x + 1] = ToByte(mean.v);
      } else if (format == PixelFormat::kI420) {
        out.row(1, y / 2)[x / 2] = ToByte(mean.u);
        out.row(2, y / 2)[x / 2] = ToByte(mean.v);
      }
    }
  }
  return out;
}

std::vector<Picture> ReadFootage(const std::string& name, int first, int count) {
  const std::string path = Asset("footage", name);
  cv::VideoCapture video(path);
  std::vector<Picture> pictures;
  cv::Mat image;
  for (int i = 0; i < first + count; ++i) {
    if (!video.read(image))
      throw std::runtime_error(path + " ends before frame " + std::to_string(i));
    if (i < first) continue;
    Picture picture(PixelFormat::kBgr24, image.cols, image.rows);
    for (int y = 0; y < image.rows; ++y) {
      std::memcpy(picture.row(0, y), image.ptr(y), static_cast<std::size_t>(3) * image.cols);
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

Picture Paste(const Picture& inner, int width, int height, int x, int y) {
  Picture out(PixelFormat::kBgr24, width, height);
  const ImageView& from = inner.view();
  for (int j = 0; j < from.height_px; ++j) {
    if (j + y < 0 || j + y >= height) continue;
    for (int i = 0; i < from.width_px; ++i) {
      if (i + x < 0 || i + x >= width) continue;
      std::copy_n(PixelAt(from, i, j), 3, out.row(0, j + y) + std::ptrdiff_t{3} * (i + x));
    }
  }
  return out;
}

}  // namespace facewire::test
