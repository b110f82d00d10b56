#include "tools/sheet/png.h"

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace facewire::tools {
namespace {

constexpr std::size_t kChannels = 3;

void AppendNumber(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xffU);
}

const Bytef* BytesOf(std::string_view text) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): characters are bytes
  return reinterpret_cast<const Bytef*>(text.data());
}

// `content` begins with the four letters of its type, which the checksum covers and the length does
// not.
void AppendChunk(std::string& png, std::string_view content) {
  AppendNumber(png, static_cast<std::uint32_t>(content.size() - 4));
  png += content;
  AppendNumber(png, static_cast<std::uint32_t>(
                        ::crc32(0, BytesOf(content), static_cast<uInt>(content.size()))));
}

// Rows of RGB, each with filter 1 in front: differences from the pixel to the left, which are zero
// wherever a drawing is of one colour.
std::string Filtered(const cv::Mat& picture) {
  const std::size_t row_bytes = kChannels * static_cast<std::size_t>(picture.cols);
  std::string rows;
  rows.reserve(static_cast<std::size_t>(picture.rows) * (1 + row_bytes));
  for (int y = 0; y < picture.rows; ++y) {
    rows += '\1';
    const std::uint8_t* row = picture.ptr(y);
    for (std::size_t i = 0; i < row_bytes; ++i) {
      const std::size_t at = i + 2 - 2 * (i % kChannels);  // BGR
      rows += static_cast<char>(row[at] - (i < kChannels ? 0 : row[at - kChannels]));
    }
  }
  return rows;
}

std::string Compressed(std::string_view type, std::string_view bytes) {
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  std::string chunk(type.size() + size, '\0');
  chunk.replace(0, type.size(), type);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): characters are bytes
  auto* to = reinterpret_cast<Bytef*>(chunk.data() + type.size());
  // Cannot fail: there is room for the worst case.
  (void)::compress2(to, &size, BytesOf(bytes), static_cast<uLong>(bytes.size()),
                    Z_DEFAULT_COMPRESSION);
  chunk.resize(type.size() + size);
  return chunk;
}

}  // namespace

std::string EncodePng(const cv::Mat& picture) {
  using namespace std::string_view_literals;
  std::string header = "IHDR";
  AppendNumber(header, static_cast<std::uint32_t>(picture.cols));
  AppendNumber(header, static_cast<std::uint32_t>(picture.rows));
  header +=
      "\x08\x02\0\0\0"sv;  // 8 bits each of red, green, blue; deflate, filters, not interlaced
  std::string png = "\x89PNG\r\n\x1a\n";
  AppendChunk(png, header);
  AppendChunk(png, Compressed("IDAT", Filtered(picture)));
  AppendChunk(png, "IEND");
  return png;
}

}  // namespace facewire::tools
