#ifndef FACEWIRE_CORE_RBF_PRINCIPAL_AXES_H_
#define FACEWIRE_CORE_RBF_PRINCIPAL_AXES_H_

#include <cstddef>
#include <span>

#include "core/base/result.h"

namespace facewire::rbf {

constexpr std::size_t PrincipalAxesWorkspaceBytes(std::size_t inputs, std::size_t axes) noexcept {
  return (inputs * inputs + inputs + 2 * inputs * axes) * sizeof(double) + 4 * alignof(double);
}

// An orthonormal basis of the `axes` directions in which the samples vary most (principal component
// analysis by subspace iteration; load time). Neighbouring landmarks move together, so a few dozen
// axes hold nearly all of the distance between two samples, and a frame costs that much less.
//   samples: count x inputs by rows (any count >= 1); basis: axes x inputs by rows, overwritten.
// kInvalidArgument: axes == 0 or > inputs, sizes that contradict, a workspace that is too small.
Result<> PrincipalAxes(std::span<const float> samples, std::size_t inputs, std::size_t axes,
                       std::span<float> basis, std::span<std::byte> workspace) noexcept;

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_PRINCIPAL_AXES_H_
