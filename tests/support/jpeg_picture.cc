#include "tests/support/jpeg_picture.h"

// jpeglib.h needs these to come first.
#include <cstdio>
#include <cstdlib>
//
#include <jpeglib.h>

namespace facewire::test {
namespace {

constexpr std::uint8_t kStartOfScan = 0xDA;

// Calls `visit(marker, offset, bytes)` for each segment up to the compressed picture, whose segment
// is the last.
template <class Visit>
void EachSegment(const Jpeg& jpeg, Visit visit) {
  std::size_t at = 2;  // after the start marker
  while (at + 4 <= jpeg.size()) {
    const std::uint8_t marker = jpeg[at + 1];
    const std::size_t bytes = 2 + (std::size_t{jpeg[at + 2]} << 8U) + jpeg[at + 3];
    visit(marker, at, bytes);
    if (marker == kStartOfScan) return;
    at += bytes;
  }
}

}  // namespace

std::array<int, 3> PixelAt(const JpegOptions& options, int x, int y) {
  const int red = 40 + 160 * x / options.width_px;
  const int green = 200 - 160 * y / options.height_px;
  if (!options.grey) return {red, green, options.shade};
  const int grey = (red + options.shade) / 2;
  return {grey, grey, grey};
}

Jpeg MakeJpeg(const JpegOptions& options) {
  jpeg_error_mgr errors{};
  jpeg_compress_struct codec{};
  codec.err = jpeg_std_error(&errors);  // an error ends the test program
  jpeg_create_compress(&codec);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&codec, &bytes, &size);
  codec.image_width = static_cast<JDIMENSION>(options.width_px);
  codec.image_height = static_cast<JDIMENSION>(options.height_px);
  codec.input_components = 3;
  codec.in_color_space = JCS_RGB;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, 95, TRUE);
  if (options.grey) {
    jpeg_set_colorspace(&codec, JCS_GRAYSCALE);
  } else {
    codec.comp_info[0].h_samp_factor = options.across;
    codec.comp_info[0].v_samp_factor = options.down;
  }
  codec.restart_in_rows = options.restart_rows;
  if (options.progressive) jpeg_simple_progression(&codec);
  jpeg_start_compress(&codec, TRUE);
  std::vector<JSAMPLE> row(3 * static_cast<std::size_t>(options.width_px));
  for (int y = 0; y < options.height_px; ++y) {
    for (int x = 0; x < options.width_px; ++x) {
      const std::array<int, 3> pixel = PixelAt(options, x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        row[3 * static_cast<std::size_t>(x) + c] = static_cast<JSAMPLE>(pixel[c]);
      }
    }
    JSAMPROW rows = row.data();
    jpeg_write_scanlines(&codec, &rows, 1);
  }
  jpeg_finish_compress(&codec);
  Jpeg jpeg(bytes, bytes + size);
  jpeg_destroy_compress(&codec);
  std::free(bytes);
  return jpeg;
}

Jpeg Without(const Jpeg& jpeg, std::uint8_t marker) {
  Jpeg kept(jpeg.begin(), jpeg.begin() + 2);
  EachSegment(jpeg, [&](std::uint8_t found, std::size_t at, std::size_t bytes) {
    const auto from = jpeg.begin() + static_cast<std::ptrdiff_t>(at);
    if (found == kStartOfScan) {
      kept.insert(kept.end(), from, jpeg.end());
    } else if (found != marker) {
      kept.insert(kept.end(), from, from + static_cast<std::ptrdiff_t>(bytes));
    }
  });
  return kept;
}

std::size_t DataOffset(const Jpeg& jpeg) {
  std::size_t offset = 0;
  EachSegment(jpeg, [&](std::uint8_t /*marker*/, std::size_t at, std::size_t bytes) {
    offset = at + bytes;
  });
  return offset;
}

}  // namespace facewire::test
