#ifndef FACEWIRE_CORE_RIG_RESPONSE_H_
#define FACEWIRE_CORE_RIG_RESPONSE_H_

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"

namespace facewire {

struct CurvePoint {
  float in = 0;
  float out = 0;
};

// How a channel answers to what drives it: curve(gain * sum + bias), in the channel's unit, counted
// from its neutral. As it stands here it changes nothing.
//
// The curve goes through its points: `in` rises, `out` never falls. In between it is smooth and
// never leaves the two outs beside it; before the first point and after the last it stays at their
// outs. So two points are a straight line with stops, and two equal outs are a dead zone. No
// points: no curve.
struct Response {
  float gain = 1;  // exaggerates (> 1), calms (< 1), reverses (< 0)
  float bias = 0;  // of a neutral face, whose sum is 0; a channel without a face is at its neutral
  InlineVector<CurvePoint, kMaxCurvePoints> curve;
};

// Monotone in `sum` (falling where the gain is negative) and continuous. NaN gives NaN.
//
// Piecewise cubic with the slopes of Fritsch and Butland, "A method for constructing local monotone
// piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5(2), 1984 (weights as in SciPy's
// PchipInterpolator); at both ends the slope of the straight line to the next point.
double Respond(const Response& response, double sum) noexcept;

// `value`, approaching `limit` from below on a soft knee: unchanged below limit - width, at the
// limit from limit + width on, a parabola in between (slope 1 to 0). That is the soft knee of audio
// limiters (Giannoulis, Massberg, Reiss, "Digital dynamic range compressor design", J. Audio Eng.
// Soc. 60(6), 2012, eq. 4 with ratio infinity and knee 2 width). Unlike an exponential or tanh it
// reaches the limit. width 0: a hard stop.
double ApproachFromBelow(double value, double limit, double width) noexcept;

}  // namespace facewire

#endif  // FACEWIRE_CORE_RIG_RESPONSE_H_
