#ifndef FACEWIRE_TOOLS_SHEET_PNG_H_
#define FACEWIRE_TOOLS_SHEET_PNG_H_

#include <opencv2/core.hpp>
#include <string>

namespace facewire::tools {

// The bytes of a PNG file (ISO/IEC 15948) of an 8-bit BGR picture that is not empty. OpenCV's own
// encoder is in a library that brings those of 30 other kinds of pictures with it, and every start
// of the command would load them.
std::string EncodePng(const cv::Mat& picture);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_PNG_H_
