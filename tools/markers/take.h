#ifndef FACEWIRE_TOOLS_MARKERS_TAKE_H_
#define FACEWIRE_TOOLS_MARKERS_TAKE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/geometry.h"

namespace facewire::tools::markers {

// A take of recorded markers, as a motion-capture system exports it.
struct Take {
  std::vector<std::string> names;
  double rate_hz = 0;  // 0 = the file does not say
  // frames[f][m] is marker m in frame f, in cm and in the axes of the file; x, y and z are all NaN
  // where the marker was not seen.
  std::vector<std::vector<Point3>> frames;
  // Of each frame, as the file says it; empty when it does not.
  std::vector<std::uint64_t> numbers;
  std::vector<std::int64_t> times_us;

  // The frame's number in its recording; without any, its place here.
  std::uint64_t Number(std::size_t frame) const;
  // Since the first frame; without times by the rate, which counts as 60 Hz when it is not known.
  std::int64_t TimeUs(std::size_t frame) const;
};

// Reads a .csv, .trc or .c3d file, told apart by the ending of its name (any case).
// Throws BadInput: "FILE: what is wrong; what would be right"; also for frames that are not in the
// order of time.
Take ReadTake(const std::string& path);

// What a .csv may hold.
struct CsvRules {
  bool only_markers = false;  // else columns of other names are passed over
  bool gaps = true;           // markers that were not seen
};

// The readers for each format, of a file's whole contents; `name` is for messages.
//   csv: a header with NAME_x,NAME_y,NAME_z for each marker, then one line a frame, in cm; an empty
//        field or "nan" is a gap. Columns "frame" and "t_us", "time_s" or "time" (seconds) count
//        and time the frames; a recording may leave frames out.
//   trc: Motion Analysis text, tab-separated; its unit is converted.
//   c3d: the binary format of c3d.org with the number format of Intel processors, integer or real;
//        its unit is converted, analogue channels are skipped.
Take ReadCsv(const std::string& contents, const std::string& name, CsvRules rules = {});
Take ReadTrc(const std::string& contents, const std::string& name);
Take ReadC3d(const std::string& contents, const std::string& name);

// Centimetres in one of a unit that a file names ("mm", "cm", "m", "in"); throws BadInput for
// others.
double CentimetresPer(const std::string& unit, const std::string& name);

}  // namespace facewire::tools::markers

#endif  // FACEWIRE_TOOLS_MARKERS_TAKE_H_
