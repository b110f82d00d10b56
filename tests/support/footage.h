#ifndef FACEWIRE_TESTS_SUPPORT_FOOTAGE_H_
#define FACEWIRE_TESTS_SUPPORT_FOOTAGE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/track/tracker.h"

namespace facewire::test {

// The contents of a network file of FACEWIRE_ASSETS. Throws std::runtime_error when it is not
// there.
std::vector<std::byte> ReadNetwork(const std::string& name);

// The files for a model, and views of them.
struct NetworkBytes {
  explicit NetworkBytes(track::Model model);
  track::NetworkFiles files() const { return {detector, landmarks}; }
  std::vector<std::byte> detector;
  std::vector<std::byte> landmarks;
};

// A picture that owns its pixels.
class Picture {
 public:
  // Black; `padding` bytes behind each row, which hold a value that no test may see.
  Picture(PixelFormat format, int width, int height, int padding = 0,
          YuvEncoding encoding = YuvEncoding::kBt601Limited);
  // The view points into the pixels, which stay where they are in a move.
  Picture(Picture&&) = default;
  Picture& operator=(Picture&&) = default;

  const ImageView& view() const { return view_; }
  Frame frame(std::uint64_t seq = 0) const { return {.seq = seq, .captured = {}, .image = view_}; }
  std::uint8_t* row(std::size_t plane, int y);

  // The same picture in another format; chroma is the mean of its block. From BGR only.
  Picture As(PixelFormat format, int padding = 0,
             YuvEncoding encoding = YuvEncoding::kBt601Limited) const;

 private:
  ImageView view_;
  std::vector<std::vector<std::uint8_t>> pixels_;
};

// `count` frames of a clip of FACEWIRE_ASSETS, from frame `first` on, as BGR. Throws
// std::runtime_error when the clip is not there or too short.
std::vector<Picture> ReadFootage(const std::string& name, int first, int count);

// One picture around another: `x` and `y` are where it goes; black around it. BGR only.
Picture Paste(const Picture& inner, int width, int height, int x, int y);

}  // namespace facewire::test

#endif  // FACEWIRE_TESTS_SUPPORT_FOOTAGE_H_
