#include "tools/sheet/png.h"

#include <png.h>

#include "app/error.h"

namespace facewire::tools {

std::string EncodePng(const cv::Mat& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.cols);
  image.height = static_cast<png_uint_32>(picture.rows);
  image.format = PNG_FORMAT_BGR;
  const auto row_bytes = static_cast<png_int_32>(picture.step[0]);
  std::string png(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = png.size();
  if (png_image_write_to_memory(&image, png.data(), &size, 0, picture.data, row_bytes, nullptr) ==
      0) {
    throw app::Failure(std::string("encoding the picture failed: ") +
                       std::string(std::begin(image.message)));
  }
  png.resize(size);
  return png;
}

}  // namespace facewire::tools
