#ifndef FACEWIRE_TOOLS_SHEET_CHARACTER_H_
#define FACEWIRE_TOOLS_SHEET_CHARACTER_H_

#include "core/rig/rig.h"
#include "core/rig_pose.h"
#include "tools/sheet/canvas.h"

namespace facewire::tools {

// What a schematic head shows of a rig's pose. Left and right are the character's own, the picture
// is not mirrored: the left eye is on the right. 0 is neutral throughout.
struct CharacterPose {
  double jaw = 0;                                // 0 closed .. 1 as far open as the rig allows
  double lid_left = 0, lid_right = 0;            // 0 open .. 1 shut
  double brow_left = 0, brow_right = 0;          // -1 down .. 1 up
  double corner_left_x = 0, corner_right_x = 0;  // of the lips: -1 pursed .. 1 wide
  double corner_left_y = 0, corner_right_y = 0;  // -1 down .. 1 up
  double gaze_x = 0, gaze_y = 0;                 // -1 to the character's right, down .. 1 left, up
  double pitch_deg = 0, yaw_deg = 0, roll_deg = 0;  // of the head, as HeadAngles
};

// Reads a pose by the names and ranges of the rig's channels. What a rig has no channel for stays
// neutral.
CharacterPose CharacterPoseOf(const Rig& rig, const RigPose& pose);

// Draws the head into the box, as large as fits.
void DrawCharacter(const CharacterPose& pose, const cv::Rect2d& box, Canvas& canvas);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_CHARACTER_H_
