#ifndef FACEWIRE_TOOLS_SHEET_HEAD_H_
#define FACEWIRE_TOOLS_SHEET_HEAD_H_

#include <span>
#include <string>

#include "tools/sheet/canvas.h"

namespace facewire::tools {

// What every sheet shares, in pixels of the finished picture.
inline constexpr int kSheetWidthPx = 1600;
inline constexpr double kMargin = 28;
inline constexpr double kHeadHeight = 170;
inline constexpr double kSmall = 8.5;  // height of a capital in running text

// A number as snprintf writes it: ("%.1f s", 2.5).
std::string Number(const char* format, double value);

// A figure for the head of a sheet: {"24.0", "frames a second"}. At most kMaxFigures are drawn.
struct Figure {
  std::string value;
  std::string label;
};
inline constexpr std::size_t kMaxFigures = 8;

// Draws title and figures into the uppermost kHeadHeight.
void DrawHead(const std::string& title, std::span<const Figure> figures, Canvas& canvas);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_HEAD_H_
