#ifndef FACEWIRE_TOOLS_FACEWIRE_MONITOR_VIEW_H_
#define FACEWIRE_TOOLS_FACEWIRE_MONITOR_VIEW_H_

#include <string>

#include "tools/facewire/monitor_model.h"

// What `facewire monitor` shows, as text; no terminal is touched here.
namespace facewire::tools {

struct ScreenSize {
  int columns = 80;
  int rows = 24;
};

struct ScreenStyle {
  bool unicode = true;  // otherwise ASCII alone
  bool colour = true;
};

// Exactly `rows` lines of at most `columns` characters, separated by line feeds, none at the end.
// With colour, escape sequences besides, each ended on its line. Channels stand in as many columns
// as the terminal has room for; those that fit nowhere are counted on the last line.
std::string DrawScreen(const MonitorModel& model, ScreenSize size, ScreenStyle style);

// A bar of `width` characters for a value between min and max: filled from neutral to the value,
// with a mark at neutral. NaN is drawn as neutral.
std::string DrawBar(double value, double neutral, double min, double max, int width, bool unicode);

// "-12.5 deg" or, with Unicode, "-12.5°"; parameters have no unit.
std::string ValueText(const Channel& channel, float value, bool unicode);

// One line for a log, without a line feed.
std::string PlainLine(const MonitorModel& model);

// Several lines, each ended by a line feed: what arrived and what did not.
std::string SummaryText(const MonitorModel& model);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_MONITOR_VIEW_H_
