#ifndef FACEWIRE_TESTS_CORE_WIRE_VECTORS_H_
#define FACEWIRE_TESTS_CORE_WIRE_VECTORS_H_

#include <string>
#include <vector>

#include "tests/core/wire/raw_frame.h"

namespace facewire::wire {

// One stream of bytes that every receiver must read alike: vectors/NAME.bin, and what it means in
// vectors/NAME.json.
struct Vector {
  std::string name;
  std::string about;
  Bytes stream;
};

std::vector<Vector> AllVectors();

}  // namespace facewire::wire

#endif  // FACEWIRE_TESTS_CORE_WIRE_VECTORS_H_
