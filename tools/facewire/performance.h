#ifndef FACEWIRE_TOOLS_FACEWIRE_PERFORMANCE_H_
#define FACEWIRE_TOOLS_FACEWIRE_PERFORMANCE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/face_pose.h"
#include "tools/facewire/face_reader.h"
#include "tools/facewire/marker_layout.h"

namespace facewire::tools {

// One frame of a recorded performance, with head motion removed; no face where none was seen.
struct PerformanceFrame {
  std::uint64_t frame = 0;
  std::int64_t t_us = 0;  // since the recording's first frame
  std::optional<FacePose> face;
};

// A recorded performance, frame by frame.
class Performance {
 public:
  virtual ~Performance() = default;
  // nullopt at the end. Throws BadInput, Failure.
  virtual std::optional<PerformanceFrame> Next() = 0;
};

// What is done to landmarks over time. Stills are no film: smoothing would mix one into the next.
enum class Smoothing { kAsTheService, kNone };

// A video, a camera or a landmark file: tracked or read, smoothed, and freed from head motion as
// the service does it.
std::unique_ptr<Performance> OpenVideo(const FaceOptions& options,
                                       Smoothing smoothing = Smoothing::kAsTheService);

// Recorded markers (tools/markers/take.h), in the places of `layout`. `rigid` names markers
// that only follow the head, at least three not on one line: head motion is removed by their fit to
// the first frame that has them all; without names, the take counts as free of head motion. A frame
// with a gap in a marker that is read has no face. Throws BadInput, naming the markers that the
// take lacks.
std::unique_ptr<Performance> OpenMarkers(const std::string& path, const MarkerLayout& layout,
                                         const std::vector<std::string>& rigid);

// True when the name ends as a marker file's does.
bool IsMarkerFile(const std::string& path);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_PERFORMANCE_H_
