#include "core/rig/response.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace facewire {
namespace {

double Width(const CurvePoint& a, const CurvePoint& b) noexcept { return double{b.in} - a.in; }
double Secant(const CurvePoint& a, const CurvePoint& b) noexcept {
  return (double{b.out} - a.out) / Width(a, b);
}

double SlopeAt(std::span<const CurvePoint> points, std::size_t i) noexcept {
  if (i == 0) return Secant(points[0], points[1]);
  if (i + 1 == points.size()) return Secant(points[i - 1], points[i]);
  const double before = Secant(points[i - 1], points[i]);
  const double after = Secant(points[i], points[i + 1]);
  if (before <= 0 || after <= 0) return 0;  // beside a flat piece
  const double h0 = Width(points[i - 1], points[i]);
  const double h1 = Width(points[i], points[i + 1]);
  return 3 * (h0 + h1) / ((2 * h1 + h0) / before + (h1 + 2 * h0) / after);
}

double Interpolate(std::span<const CurvePoint> points, double x) noexcept {
  if (x <= points.front().in) return points.front().out;
  if (x >= points.back().in) return points.back().out;
  std::size_t i = 0;
  while (i + 2 < points.size() && x >= points[i + 1].in) ++i;
  const CurvePoint& a = points[i];
  const CurvePoint& b = points[i + 1];
  // Cubic Hermite; t runs from 0 at a to 1 at b.
  const double h = Width(a, b);
  const double t = (x - a.in) / h;
  const double u = 1 - t;
  const double y = (1 + 2 * t) * u * u * a.out + (1 + 2 * u) * t * t * b.out +
                   h * t * u * (u * SlopeAt(points, i) - t * SlopeAt(points, i + 1));
  return std::min<double>(std::max<double>(y, a.out), b.out);  // for the last bit of rounding
}

}  // namespace

double Respond(const Response& response, double sum) noexcept {
  const double x = response.gain * sum + response.bias;
  return response.curve.size() < 2 ? x : Interpolate(response.curve.span(), x);
}

double ApproachFromBelow(double value, double limit, double width) noexcept {
  if (value <= limit - width) return value;
  if (value >= limit + width) return limit;
  const double left = limit + width - value;
  return limit - left * left / (4 * width);
}

}  // namespace facewire
