#include "core/track/crop.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace facewire::track {
namespace {

static_assert(std::endian::native == std::endian::little,
              "channels are taken out of words by shifts");

// Samples are made in runs of this many: short enough to stay in the first-level cache, a constant
// so that the loops over a run are vectorised whole. Divides both network sizes.
constexpr int kRun = 64;
static_assert(kDetectorSize % kRun == 0 && kLandmarkSize % kRun == 0);
template <class T>
using Run = std::array<T, kRun>;
constexpr std::ptrdiff_t kRunFloats = std::ptrdiff_t{3} * kRun;

std::uint32_t Load16(const std::uint8_t* at) noexcept {
  std::uint16_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return word;
}
std::uint32_t Load32(const std::uint8_t* at) noexcept {
  std::uint32_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return word;
}

// A pixel format is told by how two neighbours in a row become two words, and in which byte of such
// a word each channel lies. Only bytes of those two pixels may be read.
struct Pair {
  std::uint32_t left, right;
};

struct Packed24 {
  static constexpr bool kIsYuv = false;
  explicit Packed24(const ImageView& image) noexcept : plane(image.planes[0]) {}
  Pair Load(int x, int y) const noexcept {
    const std::uint8_t* at =
        plane.data + static_cast<std::ptrdiff_t>(y) * plane.stride_bytes + std::ptrdiff_t{3} * x;
    // The six bytes of both, as two overlapping words; each has a byte of the other at its far end.
    return {Load32(at), Load32(at + 2) >> 8};
  }
  Plane plane;
};
struct Rgb24 : Packed24 {
  static constexpr std::array<int, 3> kShifts = {0, 8, 16};
  using Packed24::Packed24;
};
struct Bgr24 : Packed24 {
  static constexpr std::array<int, 3> kShifts = {16, 8, 0};
  using Packed24::Packed24;
};

struct Grey8 {
  static constexpr bool kIsYuv = false;
  static constexpr std::array<int, 3> kShifts = {0, 0, 0};
  explicit Grey8(const ImageView& image) noexcept : plane(image.planes[0]) {}
  Pair Load(int x, int y) const noexcept {
    const std::uint8_t* at = plane.data + static_cast<std::ptrdiff_t>(y) * plane.stride_bytes + x;
    return {at[0], at[1]};
  }
  Plane plane;
};

struct Yuyv {
  static constexpr bool kIsYuv = true;
  static constexpr std::array<int, 3> kShifts = {0, 8, 24};
  explicit Yuyv(const ImageView& image) noexcept : plane(image.planes[0]) {}
  Pair Load(int x, int y) const noexcept {
    const std::uint8_t* row = plane.data + static_cast<std::ptrdiff_t>(y) * plane.stride_bytes;
    return {One(row, x), One(row, x + 1)};
  }
  static std::uint32_t One(const std::uint8_t* row, int x) noexcept {
    // Y0 U Y1 V: the first one's brightness makes way for the pixel's own.
    const std::uint32_t word = Load32(row + std::ptrdiff_t{4} * (x >> 1));
    return (word & 0xff00ff00U) | row[std::ptrdiff_t{2} * x];
  }
  Plane plane;
};

struct Nv12 {
  static constexpr bool kIsYuv = true;
  static constexpr std::array<int, 3> kShifts = {0, 8, 16};
  explicit Nv12(const ImageView& image) noexcept : luma(image.planes[0]), chroma(image.planes[1]) {}
  Pair Load(int x, int y) const noexcept {
    const std::uint8_t* at = luma.data + static_cast<std::ptrdiff_t>(y) * luma.stride_bytes + x;
    const std::uint8_t* uv =
        chroma.data + static_cast<std::ptrdiff_t>(y >> 1) * chroma.stride_bytes;
    return {at[0] | Load16(uv + std::ptrdiff_t{2} * (x >> 1)) << 8,
            at[1] | Load16(uv + std::ptrdiff_t{2} * ((x + 1) >> 1)) << 8};
  }
  Plane luma, chroma;
};

struct I420 {
  static constexpr bool kIsYuv = true;
  static constexpr std::array<int, 3> kShifts = {0, 8, 16};
  explicit I420(const ImageView& image) noexcept
      : luma(image.planes[0]), u_plane(image.planes[1]), v_plane(image.planes[2]) {}
  Pair Load(int x, int y) const noexcept {
    const std::uint8_t* at = luma.data + static_cast<std::ptrdiff_t>(y) * luma.stride_bytes + x;
    const std::uint8_t* u =
        u_plane.data + static_cast<std::ptrdiff_t>(y >> 1) * u_plane.stride_bytes;
    const std::uint8_t* v =
        v_plane.data + static_cast<std::ptrdiff_t>(y >> 1) * v_plane.stride_bytes;
    const auto one = [&](int i) {
      return static_cast<std::uint32_t>(u[i >> 1] << 8 | v[i >> 1] << 16);
    };
    return {at[0] | one(x), at[1] | one(x + 1)};
  }
  Plane luma, u_plane, v_plane;
};

// BT.601 (ITU-R BT.601-7, 2.5): R, G, B in 0..255 from Y, U, V in 0..255.
struct YuvToRgb {
  float y_scale, y_offset, v_to_r, u_to_g, v_to_g, u_to_b;
};
constexpr YuvToRgb kFull = {1.0F, 0.0F, 1.402F, -0.344136F, -0.714136F, 1.772F};
constexpr YuvToRgb kLimited = {1.164384F, 16.0F, 1.596027F, -0.391762F, -0.812968F, 2.017232F};

// Where the samples lie, in pixels counted from the centre of the first one.
struct Grid {
  float x0, y0;              // of the first sample
  float step_x_x, step_x_y;  // from a sample to the next one in its row
  float step_y_x, step_y_y;  // from a row to the next
};

// What becomes of a value 0..255.
struct Range {
  float scale, offset;
};

enum class Border { kRepeat, kBlack };

// The comparison's order makes NaN the lower limit, so that no coordinate leaves the picture.
float Clamp(float v, float low, float high) noexcept {
  const float raised = v > low ? v : low;
  return raised < high ? raised : high;
}

struct Positions {
  Run<int> x, y;            // the upper left one of the four pixels
  Run<float> right, lower;  // weights of the right and the lower ones
  Run<float> inside;        // 1 in the picture, 0 outside
};

void Locate(const Grid& grid, int row, int first, int width, int height, Positions& p) noexcept {
  const auto r = static_cast<float>(row);
  const float base_x = grid.x0 + r * grid.step_y_x;
  const float base_y = grid.y0 + r * grid.step_y_y;
  const auto last_x = static_cast<float>(width - 1);
  const auto last_y = static_cast<float>(height - 1);
  for (int i = 0; i < kRun; ++i) {
    const auto c = static_cast<float>(first + i);
    const float x = base_x + c * grid.step_x_x;
    const float y = base_y + c * grid.step_x_y;
    const float in_x = Clamp(x, 0.0F, last_x);
    const float in_y = Clamp(y, 0.0F, last_y);
    // The last pixel is reached as the right neighbour of the one before, with weight 1.
    p.x[i] = static_cast<int>(in_x < last_x - 1.0F ? in_x : last_x - 1.0F);
    p.y[i] = static_cast<int>(in_y < last_y - 1.0F ? in_y : last_y - 1.0F);
    p.right[i] = in_x - static_cast<float>(p.x[i]);
    p.lower[i] = in_y - static_cast<float>(p.y[i]);
    p.inside[i] =
        (x >= -0.5F) & (x <= last_x + 0.5F) & (y >= -0.5F) & (y <= last_y + 0.5F) ? 1.0F : 0.0F;
  }
}

struct Words {
  Run<std::uint32_t> upper_left, upper_right, lower_left, lower_right;
};

template <class Format>
void Gather(const Format& format, const Positions& p, Words& w) noexcept {
  for (int i = 0; i < kRun; ++i) {
    const Pair upper = format.Load(p.x[i], p.y[i]);
    const Pair lower = format.Load(p.x[i], p.y[i] + 1);
    w.upper_left[i] = upper.left;
    w.upper_right[i] = upper.right;
    w.lower_left[i] = lower.left;
    w.lower_right[i] = lower.right;
  }
}

template <int kShift>
void Blend(const Words& w, const Positions& p, Run<float>& out) noexcept {
  const auto value = [](std::uint32_t word) {
    return static_cast<float>(static_cast<int>((word >> kShift) & 0xffU));
  };
  for (int i = 0; i < kRun; ++i) {
    const float left = value(w.upper_left[i]);
    const float below = value(w.lower_left[i]);
    const float upper = left + p.right[i] * (value(w.upper_right[i]) - left);
    const float lower = below + p.right[i] * (value(w.lower_right[i]) - below);
    out[i] = upper + p.lower[i] * (lower - upper);
  }
}

void ToRgb(const YuvToRgb& m, Run<float>& a, Run<float>& b, Run<float>& c) noexcept {
  for (int i = 0; i < kRun; ++i) {
    const float y = m.y_scale * (a[i] - m.y_offset);
    const float u = b[i] - 128.0F;
    const float v = c[i] - 128.0F;
    a[i] = Clamp(y + m.v_to_r * v, 0.0F, 255.0F);
    b[i] = Clamp(y + m.u_to_g * u + m.v_to_g * v, 0.0F, 255.0F);
    c[i] = Clamp(y + m.u_to_b * u, 0.0F, 255.0F);
  }
}

void Store(const Run<float>& r, const Run<float>& g, const Run<float>& b, Range range,
           float* __restrict out) noexcept {
  for (int i = 0; i < kRun; ++i, out += 3) {
    out[0] = r[i] * range.scale + range.offset;
    out[1] = g[i] * range.scale + range.offset;
    out[2] = b[i] * range.scale + range.offset;
  }
}

void Blacken(const Run<float>& inside, Run<float>& channel) noexcept {
  for (int i = 0; i < kRun; ++i) channel[i] *= inside[i];
}

template <Border kBorder, class Format>
void Sample(const ImageView& image, const Grid& grid, int size, Range range, float* out) noexcept {
  const Format format(image);
  const YuvToRgb& yuv = image.encoding == YuvEncoding::kBt601Full ? kFull : kLimited;
  Positions positions;
  Words words;
  Run<float> r;
  Run<float> g;
  Run<float> b;
  for (int row = 0; row < size; ++row) {
    for (int first = 0; first < size; first += kRun, out += kRunFloats) {
      Locate(grid, row, first, image.width_px, image.height_px, positions);
      Gather(format, positions, words);
      Blend<Format::kShifts[0]>(words, positions, r);
      if constexpr (Format::kShifts[0] == Format::kShifts[1]) {
        g = r;
        b = r;
      } else {
        Blend<Format::kShifts[1]>(words, positions, g);
        Blend<Format::kShifts[2]>(words, positions, b);
      }
      if constexpr (Format::kIsYuv) ToRgb(yuv, r, g, b);
      if constexpr (kBorder == Border::kBlack) {
        Blacken(positions.inside, r);
        Blacken(positions.inside, g);
        Blacken(positions.inside, b);
      }
      Store(r, g, b, range, out);
    }
  }
}

template <Border kBorder>
void SampleAny(const ImageView& image, const Grid& grid, int size, Range range,
               float* out) noexcept {
  switch (image.format) {
    case PixelFormat::kGrey8:
      return Sample<kBorder, Grey8>(image, grid, size, range, out);
    case PixelFormat::kYuyv:
      return Sample<kBorder, Yuyv>(image, grid, size, range, out);
    case PixelFormat::kNv12:
      return Sample<kBorder, Nv12>(image, grid, size, range, out);
    case PixelFormat::kI420:
      return Sample<kBorder, I420>(image, grid, size, range, out);
    case PixelFormat::kRgb24:
      return Sample<kBorder, Rgb24>(image, grid, size, range, out);
    case PixelFormat::kBgr24:
      return Sample<kBorder, Bgr24>(image, grid, size, range, out);
  }
}

bool HasRows(const Plane& plane, int row_bytes) noexcept {
  return plane.data != nullptr && plane.stride_bytes >= row_bytes;
}

}  // namespace

Result<> CheckImage(const ImageView& image) noexcept {
  constexpr int kMaxSide = 1 << 14;  // pixels; keeps every offset within an int
  const int width = image.width_px;
  if (width < 2 || image.height_px < 2 || width > kMaxSide || image.height_px > kMaxSide) {
    return Errc::kUnsupported;
  }
  const int half = (width + 1) / 2;
  const auto& planes = image.planes;
  bool good = false;
  switch (image.format) {
    case PixelFormat::kGrey8:
      good = HasRows(planes[0], width);
      break;
    case PixelFormat::kYuyv:
      good = HasRows(planes[0], 4 * half);
      break;
    case PixelFormat::kNv12:
      good = HasRows(planes[0], width) && HasRows(planes[1], 2 * half);
      break;
    case PixelFormat::kI420:
      good = HasRows(planes[0], width) && HasRows(planes[1], half) && HasRows(planes[2], half);
      break;
    case PixelFormat::kRgb24:
    case PixelFormat::kBgr24:
      good = HasRows(planes[0], 3 * width);
      break;
    default:  // a number that is none of the formats
      return Errc::kUnsupported;
  }
  if (!good) return Errc::kInvalidArgument;
  return {};
}

void CropLetterbox(const ImageView& image, std::span<float> out) noexcept {
  const auto width = static_cast<float>(image.width_px);
  const auto height = static_cast<float>(image.height_px);
  const float side = std::max(width, height);
  const float step = side / static_cast<float>(kDetectorSize);
  const Grid grid = {.x0 = 0.5F * (width - side) + 0.5F * step - 0.5F,
                     .y0 = 0.5F * (height - side) + 0.5F * step - 0.5F,
                     .step_x_x = step,
                     .step_x_y = 0,
                     .step_y_x = 0,
                     .step_y_y = step};
  SampleAny<Border::kBlack>(image, grid, kDetectorSize, {2.0F / 255.0F, -1.0F}, out.data());
}

void CropRegion(const ImageView& image, const Region& region, std::span<float> out) noexcept {
  const CropToPicture to_picture(region, static_cast<float>(kLandmarkSize));
  const Point3 first = to_picture({0.5F, 0.5F, 0});
  const Point3 step_x = to_picture.Turn({1, 0, 0});
  const Point3 step_y = to_picture.Turn({0, 1, 0});
  const Grid grid = {.x0 = first.x - 0.5F,
                     .y0 = first.y - 0.5F,
                     .step_x_x = step_x.x,
                     .step_x_y = step_x.y,
                     .step_y_x = step_y.x,
                     .step_y_y = step_y.y};
  SampleAny<Border::kRepeat>(image, grid, kLandmarkSize, {1.0F / 255.0F, 0.0F}, out.data());
}

}  // namespace facewire::track
