#!/usr/bin/env python3
"""Prints tests/core/rbf/golden.h: interpolants computed with NumPy, independently of core/rbf.

Run: python3 tools/generate/rbf_golden.py > tests/core/rbf/golden.h
"""
import numpy as np

KERNELS = [
    ("kMultiquadric", lambda u: np.sqrt(1 + u * u), -1),
    ("kInverseMultiquadric", lambda u: 1 / np.sqrt(1 + u * u), 1),
    ("kGaussian", lambda u: np.exp(-u * u), 1),
    ("kLinear", lambda u: u, -1),
    ("kCubic", lambda u: u**3, 1),
]
TAILS = [("kNone", 0), ("kConstant", 1), ("kLinear", 3)]


def matrix(x, phi, sign, eps, smoothing, tail, tail_smoothing, mean):
    h = phi(eps * np.linalg.norm(x[:, None] - x[None], axis=2)) + sign * smoothing * np.eye(len(x))
    p = np.c_[np.ones(len(x)), x - mean][:, :tail]
    z = -sign * tail_smoothing * np.eye(tail)
    if tail:
        z[0, 0] = 0
    return np.block([[h, p], [p.T, z]]), p


def fit(x, t, *args):
    a, _ = matrix(x, *args)
    return np.linalg.solve(a, np.r_[t, np.zeros((len(a) - len(x), t.shape[1]))])


def predict(at, x, w, phi, eps, tail, mean):
    h = phi(eps * np.linalg.norm(at[:, None] - x[None], axis=2))
    return np.c_[h, np.c_[np.ones(len(at)), at - mean][:, :tail]] @ w


def numbers(values):
    return ", ".join(f"{v:.7g}F" if "." in f"{v:.7g}" or "e" in f"{v:.7g}" else f"{v:.7g}.0F"
                     for v in np.ravel(values))


def main():
    rng = np.random.default_rng(1)
    x = rng.uniform(-1, 1, (9, 2)).astype(np.float32).astype(float)
    t = np.c_[np.sin(2 * x[:, 0]) + x[:, 1], x[:, 0] * x[:, 1]].astype(np.float32).astype(float)
    at = np.array([[0.1, -0.2], [1.5, 1.0]])
    print("#ifndef FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_\n#define FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_\n")
    print("#include <array>\n\n#include \"core/rbf/kernel.h\"\n")
    print("// Written by tools/generate/rbf_golden.py (NumPy).\n// clang-format off")
    print("namespace facewire::rbf::golden {\n")
    print(f"inline constexpr std::array<float, 18> kSamples = {{{numbers(x)}}};")
    print(f"inline constexpr std::array<float, 18> kTargets = {{{numbers(t)}}};")
    print(f"inline constexpr std::array<float, 4> kAt = {{{numbers(at)}}};\n")
    print("struct Case {\n  Kernel kernel;\n  Tail tail;\n  float epsilon, smoothing, tail_smoothing;")
    print("  std::array<float, 4> values;         // two outputs at each place of kAt")
    print("  std::array<float, 2> leave_one_out;  // of sample 3, by leaving it out\n};")
    cases = []
    for kernel, phi, sign in KERNELS:
        for tail, size in TAILS:
            for smoothing, tail_smoothing in ((0, 0), (0.05, 0.1 if size == 3 else 0)):
                eps = 0.8
                args = (phi, sign, eps, smoothing, size, tail_smoothing)
                mean = x.mean(0)
                w = fit(x, t, *args, mean)
                rest = np.arange(len(x)) != 3
                left = fit(x[rest], t[rest], *args, mean)
                error = t[3] - predict(x[3:4], x[rest], left, phi, eps, size, mean)[0]
                values = predict(at, x, w, phi, eps, size, mean)
                cases.append(f"    {{Kernel::{kernel}, Tail::{tail}, {numbers([eps, smoothing, tail_smoothing])},\n"
                             f"     {{{numbers(values)}}}, {{{numbers(error)}}}}},")
    print(f"inline constexpr std::array<Case, {len(cases)}> kCases = {{{{\n" + "\n".join(cases) + "\n}};\n")
    print("}  // namespace facewire::rbf::golden\n// clang-format on\n\n#endif  // FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_")


if __name__ == "__main__":
    main()
