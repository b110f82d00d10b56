#ifndef FACEWIRE_TESTS_SUPPORT_JPEG_PICTURE_H_
#define FACEWIRE_TESTS_SUPPORT_JPEG_PICTURE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace facewire::test {

using Jpeg = std::vector<std::uint8_t>;

struct JpegOptions {
  int width_px = 64;
  int height_px = 48;
  int shade = 0;  // 0..255, the blue of every pixel: tells pictures apart
  // Of colour: how many pixels of brightness share one, across and down.
  int across = 2;
  int down = 1;
  bool grey = false;
  bool progressive = false;
  int restart_rows = 0;  // a restart marker after so many rows of blocks; 0: none
};

// A smooth picture as a camera would compress it: PixelAt, compressed at high quality.
Jpeg MakeJpeg(const JpegOptions& options);

// Red, green, blue of that picture before it was compressed.
std::array<int, 3> PixelAt(const JpegOptions& options, int x, int y);

// The segments with `marker` (0xC4: Huffman tables, 0xDB: quantization tables) left out.
Jpeg Without(const Jpeg& jpeg, std::uint8_t marker);

// Where the compressed picture begins, after the header.
std::size_t DataOffset(const Jpeg& jpeg);

}  // namespace facewire::test

#endif  // FACEWIRE_TESTS_SUPPORT_JPEG_PICTURE_H_
