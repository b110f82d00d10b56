#ifndef FACEWIRE_TOOLS_SHEET_OVERLAY_H_
#define FACEWIRE_TOOLS_SHEET_OVERLAY_H_

#include "core/landmarks.h"
#include "tools/sheet/canvas.h"

namespace facewire::tools {

// Draws landmarks over the picture they belong to, whose top-left corner is at `origin` and whose
// pixels are `zoom` wide and high on the canvas: every point as a dot, the outlines of face, eyes,
// brows and lips, and the irises where the network gives them.
void DrawLandmarks(const Landmarks& landmarks, cv::Point2d origin, cv::Size2d zoom, Canvas& canvas);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_OVERLAY_H_
