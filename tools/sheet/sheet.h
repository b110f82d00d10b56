#ifndef FACEWIRE_TOOLS_SHEET_SHEET_H_
#define FACEWIRE_TOOLS_SHEET_SHEET_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/landmarks.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"
#include "tools/sheet/head.h"

namespace facewire::tools {

// One row of a contact sheet: what the camera saw, and what the character was told at that frame.
struct Moment {
  std::string caption;      // "mouth wide open"
  std::uint64_t frame = 0;  // of the recording
  double time_s = 0;        // in the recording
  cv::Mat picture;          // 8-bit BGR
  Landmarks landmarks;      // of the picture; count 0 = no face
  RigPose pose;
};

// Draws a contact sheet, kSheetWidthPx wide and as high as the moments need: title and figures on
// top, then a row for each moment: the picture with its landmarks, the character, and bars for the
// channels of the rig that move most in these moments. The result is 8-bit BGR.
cv::Mat DrawSheet(const std::string& title, std::span<const Figure> figures, const Rig& rig,
                  std::span<const Moment> moments);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_SHEET_H_
