#ifndef FACEWIRE_CORE_TRACK_OPERATOR_SHAPE_H_
#define FACEWIRE_CORE_TRACK_OPERATOR_SHAPE_H_

#include <array>

#include "core/track/tflite_model.h"

namespace facewire::track {

// What a PAD adds in front of and behind each dimension.
struct Padding {
  std::array<int, 4> before{};
  std::array<int, 4> behind{};
};

// The constant paddings of a PAD operator; all zero if there are none that make sense.
Padding ReadPadding(const TfliteModel& model, const Operator& op) noexcept;

// Whether the operator is one of those that XnnNetwork runs, in a form that it runs, and the shapes
// of its inputs, constants and output fit each other. XNNPACK trusts the declared shapes when it
// lays out memory, so a file whose shapes contradict each other must not get that far.
bool IsConsistent(const TfliteModel& model, const Operator& op) noexcept;

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_OPERATOR_SHAPE_H_
