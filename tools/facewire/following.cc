#include "tools/facewire/following.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>

#include "app/error.h"
#include "tools/markers/text.h"
#include "tools/sheet/head.h"

namespace facewire::tools {
namespace {

constexpr std::string_view kHeader =
    "t_us,servo,event,detail,torque_on,goal,commanded,position,";  // of which the first 8 are used
constexpr std::size_t kFields = 8;
constexpr double kGridS = 0.002;  // finer than any bus's tick

constexpr double kLatestMs = 250;
constexpr double kMostOff = 0.1;  // part of the motion

[[noreturn]] void Refuse(const std::string& path, std::size_t line, const std::string& what) {
  throw app::BadInput(path + ":" + std::to_string(line) + ": " + what);
}

double BandOf(const servo::Servo& servo) { return std::max(servo.dead_band, servo.backlash); }

// A curve at every kGridS from `from_s`, as a line from point to point, or held.
std::vector<double> OnGrid(const Curve& curve, double from_s, std::size_t count, bool holds) {
  std::vector<double> values;
  values.reserve(count);
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = from_s + static_cast<double>(i) * kGridS;
    while (at + 1 < curve.size() && curve[at + 1].t_s <= t) ++at;
    const TimedValue& before = curve[at];
    if (holds || at + 1 == curve.size() || t < before.t_s) {
      values.push_back(before.value);
    } else {
      const TimedValue& after = curve[at + 1];
      const double part = (t - before.t_s) / (after.t_s - before.t_s);
      values.push_back(before.value + part * (after.value - before.value));
    }
  }
  return values;
}

// How `follower` follows `leader`, both on the grid; `leader` begins `early` points before.
Following Compare(const std::vector<double>& leader, const std::vector<double>& follower,
                  std::size_t early, bool moves) {
  Following best;
  double least = INFINITY;
  for (std::size_t lag = 0; lag <= (moves ? early : 0); ++lag) {
    double sum = 0;
    double largest = 0;
    for (std::size_t i = 0; i < follower.size(); ++i) {
      const double off = std::abs(follower[i] - leader[i + early - lag]);
      sum += off * off;
      largest = std::max(largest, off);
    }
    if (sum >= least) continue;
    least = sum;
    best.rms = std::sqrt(sum / static_cast<double>(follower.size()));
    best.largest = largest;
    if (moves) best.lag_ms = static_cast<double>(lag) * kGridS * 1000;
  }
  return best;
}

double ValueAt(const Curve& curve, double t_s) { return OnGrid(curve, t_s, 1, false).front(); }

// See ServoFollowing.
TimeSpan SpanOf(const servo::Servo& servo, const Curve& parameter,
                const std::vector<ServoRow>& rows) {
  const double near = std::max(4.0 * BandOf(servo), 0.02 * (servo.max - servo.min));
  const auto met = std::ranges::find_if(rows, [&](const ServoRow& row) {
    return row.torque_on && row.t_s >= parameter.front().t_s &&
           std::abs(row.goal - ValueAt(parameter, row.t_s)) <= near &&
           std::abs(row.commanded - row.goal) <= near;
  });
  const auto off = std::find_if(met, rows.end(), [](const ServoRow& r) { return !r.torque_on; });
  TimeSpan span{INFINITY, parameter.back().t_s};
  if (met != rows.end()) span.from_s = met->t_s + kSettledS;
  if (off != rows.end()) span.to_s = std::min(span.to_s, off->t_s);
  if (span.to_s - span.from_s < 1) {
    throw app::BadInput("servo \"" + std::string(servo.name.view()) + "\" was never " +
                        (met == rows.end() ? "told to be where its parameter was"
                                           : "at work for long enough to say how it follows"));
  }
  return span;
}

// The kCloseUpS in which the values go the longest way.
TimeSpan Liveliest(const std::vector<double>& values, TimeSpan span) {
  const auto window =
      static_cast<std::size_t>(std::min(kCloseUpS, span.to_s - span.from_s) / kGridS);
  double way = 0;
  double longest = -1;
  std::size_t end = window;
  for (std::size_t i = 1; i < values.size(); ++i) {
    way += std::abs(values[i] - values[i - 1]);
    if (i > window) way -= std::abs(values[i - window] - values[i - window - 1]);
    if (i < window || way <= longest) continue;
    longest = way;
    end = i;
  }
  const double to_s = span.from_s + static_cast<double>(end) * kGridS;
  return {to_s - static_cast<double>(window) * kGridS, to_s};
}

double Unresolved(const std::vector<double>& goals, const std::vector<double>& commanded) {
  double largest = 0;
  double rested_s = 0;
  for (std::size_t i = 1; i < goals.size(); ++i) {
    rested_s = goals[i] == goals[i - 1] ? rested_s + kGridS : 0;
    if (rested_s >= kRestedS) largest = std::max(largest, std::abs(commanded[i] - goals[i]));
  }
  return largest;
}

Curve CurveOf(const std::vector<ServoRow>& rows, double ServoRow::*value) {
  Curve curve;
  curve.reserve(rows.size());
  for (const ServoRow& row : rows) curve.push_back({row.t_s, row.*value});
  return curve;
}

}  // namespace

std::vector<ServoRow> ReadServoRows(const std::string& path, int index) {
  std::ifstream file(path);
  if (!file) throw app::BadInput("cannot read the trace " + path);
  const std::string contents((std::istreambuf_iterator<char>(file)),
                             std::istreambuf_iterator<char>());
  if (!contents.starts_with(kHeader)) {
    Refuse(path, 1, "no trace of a simulated bus; one begins " + std::string(kHeader) + "...");
  }
  const auto lines = markers::Lines(contents);
  std::vector<ServoRow> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = markers::Fields(lines[i], ',');
    if (fields.size() < kFields)
      Refuse(path, i + 1, "a row has " + std::to_string(kFields) + " fields at least");
    if (!fields[2].empty()) continue;  // an event
    const auto number = [&](std::size_t column) {
      const auto value = markers::NumberOrGap(fields[column]);
      if (!value || std::isnan(*value))
        Refuse(path, i + 1, "\"" + std::string(fields[column]) + "\" is not a number");
      return *value;
    };
    if (number(1) != index) continue;
    rows.push_back({number(0) * 1e-6, number(4) != 0, number(5), number(6), number(7)});
  }
  if (rows.empty()) throw app::BadInput(path + ": it has no servo " + std::to_string(index));
  return rows;
}

ServoFollowing Measure(const servo::Servo& servo, const Curve& parameter,
                       const std::vector<ServoRow>& rows) {
  ServoFollowing following;
  following.span = SpanOf(servo, parameter, rows);
  following.torque_at_end = rows.back().torque_on;
  for (const ServoRow& row : rows) {
    if (!row.torque_on) continue;
    following.beyond_limits =
        std::max({following.beyond_limits, servo.min - row.goal, row.goal - servo.max});
  }
  const auto early = static_cast<std::size_t>(kLongestLagS / kGridS);
  const auto count =
      static_cast<std::size_t>((following.span.to_s - following.span.from_s) / kGridS);
  const double early_s = following.span.from_s - kLongestLagS;
  const auto wanted = OnGrid(parameter, early_s, count + early, false);
  const auto goals = OnGrid(CurveOf(rows, &ServoRow::goal), early_s, count + early, true);
  const auto commanded =
      OnGrid(CurveOf(rows, &ServoRow::commanded), following.span.from_s, count, true);
  const auto positions =
      OnGrid(CurveOf(rows, &ServoRow::position), following.span.from_s, count, false);

  const auto begin = static_cast<std::ptrdiff_t>(early);
  const std::vector goals_now(goals.begin() + begin, goals.end());
  const std::vector wanted_now(wanted.begin() + begin, wanted.end());
  const auto [least, most] = std::ranges::minmax(wanted_now);
  following.moved = most - least;
  const bool moves = following.moved > 4 * BandOf(servo);
  following.command = Compare(wanted, goals_now, early, moves);
  following.position = Compare(goals, positions, early, moves);
  following.unresolved = Unresolved(goals_now, commanded);
  following.liveliest = Liveliest(wanted_now, following.span);
  return following;
}

std::string WhyNot(const servo::Servo& servo, const ServoFollowing& following, double step) {
  const double most_off = kMostOff * following.moved + 2 * BandOf(servo);
  if (following.torque_at_end) return "has torque at the end";
  if (following.beyond_limits > step / 2) {
    return "was told to go " + Number("%.1f", following.beyond_limits) + " beyond its limits";
  }
  if (following.command.rms > most_off) return "gets other commands than its parameter asks for";
  if (following.command.lag_ms > kLatestMs) return "gets its commands too late";
  if (following.position.rms > most_off) return "does not go where it is told";
  if (following.position.lag_ms > kLatestMs) return "moves too late";
  if (following.unresolved > step) {
    return "comes to rest " + Number("%.2f", following.unresolved) + " from its command";
  }
  return "";
}

}  // namespace facewire::tools
