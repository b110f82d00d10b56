// lossless_clip INPUT COUNT OUT: decodes the first COUNT frames of a video and writes them as PNG
// pictures, one behind the other in one file, which FFmpeg reads as a video again. Decoders differ
// by release and by processor in how they convert colours; from such a clip every machine gets the
// same pixels.
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

int main(int argc, char** argv) {
  int count = 0;
  if (argc != 4 ||
      std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), count).ec != std::errc{}) {
    std::fputs("usage: lossless_clip INPUT COUNT OUT\n", stderr);
    return 2;
  }
  cv::VideoCapture video(argv[1]);
  std::ofstream out(argv[3], std::ios::binary);
  cv::Mat image;
  std::vector<unsigned char> png;
  for (int i = 0; i < count; ++i) {
    if (!video.read(image) || !cv::imencode(".png", image, png, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
      std::fprintf(stderr, "lossless_clip: %s: cannot read frame %d\n", argv[1], i);
      return 1;
    }
    out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  }
  out.close();
  if (out.fail()) {
    std::fprintf(stderr, "lossless_clip: %s: cannot write\n", argv[3]);
    return 1;
  }
  return 0;
}
