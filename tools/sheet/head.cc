#include "tools/sheet/head.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace facewire::tools {

std::string Number(const char* format, double value) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

void DrawHead(const std::string& title, std::span<const Figure> figures, Canvas& canvas) {
  canvas.Text("facewire", {kMargin, 54}, 26, palette::kInk, Align::kLeft, true);
  canvas.Text(title, {kMargin + Canvas::TextWidth("facewire", 26, true) + 22, 54}, 13,
              palette::kMuted);
  const std::size_t count = std::min(figures.size(), kMaxFigures);
  const double width =
      (kSheetWidthPx - 2 * kMargin) / static_cast<double>(std::max<std::size_t>(count, 1));
  for (std::size_t i = 0; i < count; ++i) {
    const double x = kMargin + width * static_cast<double>(i);
    canvas.Box({x, 82, width - 10, 70}, 8, palette::kCard);
    canvas.Text(figures[i].value, {x + 14, 116}, 17, palette::kInk, Align::kLeft, true);
    canvas.Text(figures[i].label, {x + 14, 139}, kSmall, palette::kMuted);
  }
}

}  // namespace facewire::tools
