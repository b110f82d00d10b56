#ifndef FACEWIRE_TESTS_SUPPORT_GENERATED_TAKE_H_
#define FACEWIRE_TESTS_SUPPORT_GENERATED_TAKE_H_

#include <string>
#include <vector>

namespace facewire::test {

// A take of optical markers as a capture system exports it, made of formulas: 41 markers named as
// in the AnimFace data set on a face of our own, cm, y up, 60 frames a second, a head that sways,
// and a jaw and lips that go through nine poses, each reached, held and left in 1.2 seconds.
struct GeneratedTake {
  std::vector<std::string> shapes;          // what moves the jaw and the lips
  std::vector<std::vector<float>> weights;  // of each frame, of each shape, 0..1: the truth
  std::string markers_csv;                  // frame,time_s,NAME_x,NAME_y,NAME_z,...
  std::string weights_csv;                  // frame,SHAPE,...
};
GeneratedTake GenerateTake();

}  // namespace facewire::test

#endif  // FACEWIRE_TESTS_SUPPORT_GENERATED_TAKE_H_
