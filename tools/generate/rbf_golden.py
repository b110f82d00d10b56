#!/usr/bin/env python3
"""Prints tests/core/rbf/golden.h: interpolants computed with scipy 1.10, independently of core/rbf.

Run: /usr/bin/python3 tools/generate/rbf_golden.py > tests/core/rbf/golden.h   (Debian: python3-scipy)

scipy.interpolate.Rbf has no tail and subtracts its `smooth` from the diagonal, whatever the kernel; its epsilon is
a radius. RBFInterpolator has all three tails (degree -1, 0, 1), adds its smoothing to a matrix whose sign it has
turned to be positive definite, and its epsilon is ours. Neither damps a tail: those cases come from a dense solve
with NumPy.
"""
import warnings

import numpy as np
from scipy.interpolate import Rbf, RBFInterpolator
from scipy.spatial.distance import pdist
from scipy.special import xlogy

# our name, name in Rbf, name in RBFInterpolator, phi(u), sign of smoothing, whether epsilon is more than a unit
KERNELS = [
    ("Multiquadric", "multiquadric", "multiquadric", lambda u: np.sqrt(1 + u * u), -1, True),
    ("InverseMultiquadric", "inverse", "inverse_multiquadric", lambda u: 1 / np.sqrt(1 + u * u), 1, True),
    ("Gaussian", "gaussian", "gaussian", lambda u: np.exp(-u * u), 1, True),
    ("Linear", "linear", "linear", lambda u: u, -1, False),
    ("Cubic", "cubic", "cubic", lambda u: u**3, 1, False),
    ("ThinPlate", "thin_plate", "thin_plate_spline", lambda u: xlogy(u * u, u), 1, False),
]
TAILS = [("None", -1), ("Constant", 0), ("Linear", 1)]
LEFT_OUT = 3


def f32(value):
    """The nearest float, as core/rbf will read it."""
    return float(np.float32(value))


def by_rbf(kernel, tail, epsilon, smoothing, _):
    def fit(x, t):
        smooth = -kernel[4] * smoothing
        radius = 1 / epsilon if kernel[5] else 1
        columns = [Rbf(*x.T, t[:, o], function=kernel[1], epsilon=radius, smooth=smooth) for o in range(t.shape[1])]
        return lambda at: np.stack([c(*at.T) for c in columns], axis=1)
    return fit


def by_interpolator(kernel, tail, epsilon, smoothing, _):
    return lambda x, t: RBFInterpolator(x, t, kernel=kernel[2], degree=tail, epsilon=epsilon, smoothing=smoothing)


def by_numpy(kernel, tail, epsilon, smoothing, tail_smoothing):
    def fit(x, t, mean):
        def terms(at):
            h = kernel[3](epsilon * np.linalg.norm(at[:, None] - x[None], axis=2))
            return h, np.c_[np.ones(len(at)), at - mean]
        h, p = terms(x)
        damping = np.diag([0.0] + [-kernel[4] * tail_smoothing] * x.shape[1])
        a = np.block([[h + kernel[4] * smoothing * np.eye(len(x)), p], [p.T, damping]])
        w = np.linalg.solve(a, np.r_[t, np.zeros((len(a) - len(x), t.shape[1]))])
        return lambda at: np.hstack(terms(at)) @ w
    # The mean is part of what damping means, so it stays when a sample is left out.
    return lambda x, t: fit(x, t, MEAN)


def cases():
    for kernel in KERNELS:
        for tail, degree in TAILS:
            for smoothing in (0.0, f32(0.05)):
                if degree < 0:
                    yield "Rbf", by_rbf, kernel, tail, degree, f32(0.8) if kernel[5] else 1.0, smoothing, 0.0
                yield "RBFInterpolator", by_interpolator, kernel, tail, degree, f32(0.8), smoothing, 0.0
        yield "NumPy", by_numpy, kernel, "Linear", 1, f32(0.8), f32(0.05), f32(0.1)


def numbers(values, suffix=""):
    texts = [f"{v:.9g}" if suffix else f"{v:.17g}" for v in np.ravel(values)]
    return ", ".join((t if "." in t or "e" in t else t + ".0") + suffix for t in texts)


def main():
    global MEAN
    warnings.simplefilter("ignore")  # RBFInterpolator warns when the tail is less than the kernel's safe one
    rng = np.random.default_rng(1)
    x = rng.uniform(-1, 1, (11, 2)).astype(np.float32).astype(float)
    t = np.c_[np.sin(2 * x[:, 0]) + x[:, 1], x[:, 0] * x[:, 1] + 0.3].astype(np.float32).astype(float)
    at = np.array([[0.1, -0.2], [1.5, 1.0], [-0.6, 0.3]]).astype(np.float32).astype(float)
    MEAN = x.mean(0)
    rows = []
    for source, method, kernel, tail, degree, epsilon, smoothing, tail_smoothing in cases():
        fit = method(kernel, degree, epsilon, smoothing, tail_smoothing)
        rest = np.arange(len(x)) != LEFT_OUT
        error = t[LEFT_OUT] - fit(x[rest], t[rest])(x[[LEFT_OUT]])[0]
        rows.append(f"    {{\"{source}\", Kernel::k{kernel[0]}, Tail::k{tail}, "
                    f"{numbers([epsilon, smoothing, tail_smoothing], 'F')},\n"
                    f"     {{{numbers(fit(x, t)(at))}}},\n     {{{numbers(error)}}}}},")
    print(f"""#ifndef FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_
#define FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_

#include <array>
#include <string_view>

#include "core/rbf/kernel.h"

// Written by tools/generate/rbf_golden.py (scipy 1.10).
// clang-format off
namespace facewire::rbf::golden {{

inline constexpr std::array<float, {x.size}> kSamples = {{{numbers(x, 'F')}}};
inline constexpr std::array<float, {t.size}> kTargets = {{{numbers(t, 'F')}}};
inline constexpr std::array<float, {at.size}> kAt = {{{numbers(at, 'F')}}};
inline constexpr double kMeanDistance = {numbers(pdist(x).mean())};
inline constexpr std::size_t kLeftOut = {LEFT_OUT};

struct Case {{
  std::string_view source;
  Kernel kernel;
  Tail tail;
  float epsilon, smoothing, tail_smoothing;
  std::array<double, {2 * len(at)}> values;         // two outputs at each place of kAt
  std::array<double, 2> leave_one_out;  // of sample kLeftOut, by leaving it out
}};
inline constexpr std::array<Case, {len(rows)}> kCases = {{{{
""" + "\n".join(rows) + """
}};

}  // namespace facewire::rbf::golden
// clang-format on

#endif  // FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_""")


if __name__ == "__main__":
    main()
