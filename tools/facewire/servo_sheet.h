#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_SHEET_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_SHEET_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace facewire::tools {

struct ServoSheetOptions {
  std::string recording;            // of `facewire monitor --csv`
  std::string config;               // the service's, with the buses; it names the rig
  std::vector<std::string> servos;  // NAME=TRACE:INDEX, a lane each
};

struct ServoSheet {
  cv::Mat picture;
  std::string table;                 // the figures, a line each servo
  std::vector<std::string> strayed;  // "NAME WHY" of each servo that did not follow (WhyNot)
};

// Draws for each servo what its channels asked for, what its bus was told and what the servo did
// (following.h). Poses count from when they were sent. Throws BadInput.
ServoSheet SheetOfServos(const ServoSheetOptions& options);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_SHEET_H_
