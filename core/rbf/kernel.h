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
  kThinPlate = 5,            // u^2 log(u), 0 at u = 0
};
inline constexpr std::uint8_t kKernelCount = 6;

// Polynomial that is added to the radial sum. The numbers are those of profile files: append only.
// A kernel is sure to have exactly one well-behaved interpolant of samples in general position with
// at least this tail (Fasshauer, Meshfree Approximation Methods with MATLAB, chapter 8): inverse
// multiquadric and Gaussian none, multiquadric and linear constant, cubic and thin plate linear.
// README.md says what less of a tail does.
enum class Tail : std::uint8_t { kNone = 0, kConstant = 1, kLinear = 2 };
inline constexpr std::uint8_t kTailCount = 3;

// Which sign smoothing takes on the diagonal. The multiquadric and the linear kernel are
// conditionally NEGATIVE definite: adding a positive number to their diagonal walks the matrix
// towards singularity instead of away from it (Micchelli 1986), so there smoothing is subtracted.
// Cubic and thin plate are of order 2 and positive again.
constexpr double SmoothingSign(Kernel kernel) noexcept {
  return kernel == Kernel::kMultiquadric || kernel == Kernel::kLinear ? -1.0 : 1.0;
}

// Whether epsilon changes the interpolant. For the powers of r, and for the thin plate with its
// linear tail, it only rescales the weights and the unit of smoothing.
constexpr bool HasShape(Kernel kernel) noexcept {
  return kernel != Kernel::kLinear && kernel != Kernel::kCubic && kernel != Kernel::kThinPlate;
}

// phi for u^2 = (epsilon r)^2 >= 0.
double Phi(Kernel kernel, double u_squared) noexcept;

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_KERNEL_H_
