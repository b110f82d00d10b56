#ifndef FACEWIRE_TOOLS_SHEET_TRACES_H_
#define FACEWIRE_TOOLS_SHEET_TRACES_H_

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/sheet/head.h"

namespace facewire::tools {

struct TimedValue {
  double t_s;
  double value;  // NaN: none; the curve is interrupted
};
using Curve = std::vector<TimedValue>;  // in the order of time

struct TimeSpan {
  double from_s;
  double to_s;
};

// One servo: what it was to do, what it was told, what it did, all in its own unit.
struct TraceLane {
  std::string title;  // its name
  std::vector<std::string>
      subtitle;                      // where it hangs, what moves it; there is room for three lines
  std::vector<std::string> remarks;  // its figures; for five
  std::string unit;
  double low = 0, high = 0;  // the least and the most that it may be told
  Curve parameter;           // drawn as a line from point to point
  Curve command;             // holds until the next point
  Curve position;            // as parameter
  TimeSpan close_up{};       // what is also drawn large
};

// A picture of the lanes, one below the other, over `whole`, each with its close-up beside it. At
// most kMaxFigures are drawn of `figures`.
cv::Mat DrawTraces(const std::string& title, std::span<const Figure> figures,
                   std::span<const TraceLane> lanes, TimeSpan whole);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_TRACES_H_
