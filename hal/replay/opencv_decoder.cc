// The module that plays videos: OpenCV's, and so FFmpeg's, decoder.

#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "hal/replay/video_decoder.h"

namespace facewire::hal::replay {
namespace {

// OpenCV and FFmpeg report a damaged file on stderr; the camera reports it by an Errc. FFmpeg's
// level is read from the environment when the first file is opened, and an operator's own setting
// wins.
class Quiet {
 public:
  Quiet() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {
    constexpr const char* kAvLogQuiet = "-8";
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", kAvLogQuiet, 0);
  }
  ~Quiet() { cv::utils::logging::setLogLevel(before_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

// OpenCV's exceptions end here.
class OpenCvDecoder final : public VideoDecoder {
 public:
  Result<> Open(const std::string& path) override {
    try {
      const Quiet quiet;
      // Absolute, because FFmpeg takes "name:rest" for a protocol.
      const std::string absolute = std::filesystem::absolute(path).string();
      const bool open = capture_.open(absolute, cv::CAP_FFMPEG,
                                      {cv::CAP_PROP_HW_ACCELERATION, cv::VIDEO_ACCELERATION_NONE});
      if (open && capture_.read(picture_) && !picture_.empty() && picture_.type() == CV_8UC3) {
        return {};
      }
    } catch (const std::exception&) {  // OpenCV's and the file system's
    }
    return Errc::kUnsupported;
  }

  bool Advance(bool wanted) override {
    try {
      const Quiet quiet;
      if (!capture_.grab()) return false;
      if (!wanted) return true;
      const cv::Size size = picture_.size();
      return capture_.retrieve(picture_) && picture_.size() == size;
    } catch (const cv::Exception&) {
      return false;
    }
  }

  ImageView Picture() const override {
    ImageView view;
    view.format = PixelFormat::kBgr24;
    view.width_px = picture_.cols;
    view.height_px = picture_.rows;
    view.planes[0] = {picture_.data, static_cast<int>(picture_.step[0])};
    return view;
  }

  double ClaimedFps() const override { return capture_.get(cv::CAP_PROP_FPS); }
  double ClaimedFrames() const override { return capture_.get(cv::CAP_PROP_FRAME_COUNT); }

 private:
  cv::VideoCapture capture_;
  cv::Mat picture_;
};

}  // namespace

extern "C" VideoDecoder* FacewireMakeVideoDecoder();
extern "C" VideoDecoder* FacewireMakeVideoDecoder() { return new OpenCvDecoder; }

}  // namespace facewire::hal::replay
