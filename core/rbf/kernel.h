#ifndef FACEWIRE_CORE_RBF_KERNEL_H_
#define FACEWIRE_CORE_RBF_KERNEL_H_

#include <cstdint>

namespace facewire::rbf {

// The radial function phi of u = epsilon * r. The numbers are those of profile files: append only.
enum class Kernel : std::uint8_t {
  kMultiquadric = 0,         // sqrt(1 + u^2), the paper's choice
  kInverseMultiquadric = 1,  // 1 / sqrt(1 + u^2)
  kGaussian = 2,             // exp(-u^2)
  kLinear = 3,               // u
  kCubic = 4,                // u^3
};
inline constexpr std::uint8_t kKernelCount = 5;

// Polynomial that is added to the radial sum. The numbers are those of profile files: append only.
enum class Tail : std::uint8_t { kNone = 0, kConstant = 1, kLinear = 2 };
inline constexpr std::uint8_t kTailCount = 3;

// Which sign smoothing takes on the diagonal. The multiquadric and the linear kernel are
// conditionally NEGATIVE definite: adding a positive number to their diagonal walks the matrix
// towards singularity instead of away from it (Micchelli 1986), so there smoothing is subtracted.
constexpr double SmoothingSign(Kernel kernel) noexcept {
  return kernel == Kernel::kMultiquadric || kernel == Kernel::kLinear ? -1.0 : 1.0;
}

// Whether epsilon changes the interpolant. For the powers of r it only rescales the weights.
constexpr bool HasShape(Kernel kernel) noexcept {
  return kernel != Kernel::kLinear && kernel != Kernel::kCubic;
}

// phi for u^2 = (epsilon r)^2 >= 0.
double Phi(Kernel kernel, double u_squared) noexcept;

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_KERNEL_H_
