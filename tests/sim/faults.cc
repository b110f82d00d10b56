#include "tests/sim/faults.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tests/sim/random.h"

namespace facewire::sim {
namespace {

struct Rate {
  const char* name;
  double LineFaults::*value;
  double most;
};
constexpr std::array<Rate, 6> kRates = {{{"lose", &LineFaults::lose, 1},
                                         {"flip", &LineFaults::flip, 1},
                                         {"duplicate", &LineFaults::duplicate, 1},
                                         {"late", &LineFaults::late, 1},
                                         {"late-ms", &LineFaults::late_ms, 10000},
                                         {"noise", &LineFaults::noise_per_s, 10000}}};

// Takes a number off the front of `text`.
std::optional<double> TakeNumber(std::string_view& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::optional<double> TakeNumberAfter(char mark, std::string_view& text) {
  if (text.empty() || text.front() != mark) return std::nullopt;
  text.remove_prefix(1);
  return TakeNumber(text);
}

bool IsTime(double seconds) { return seconds >= 0 && seconds <= 1e6; }

Duration FromSeconds(double seconds) {
  return Duration(static_cast<Duration::rep>(std::llround(seconds * 1e6)));
}

std::optional<Fault> ParseFault(FaultKind kind, std::string_view rest) {
  const std::optional<double> servo = TakeNumberAfter(':', rest);
  const std::optional<double> at = TakeNumberAfter('@', rest);
  if (!servo || !at || *servo != std::floor(*servo) || *servo < 0 || *servo > 252 || !IsTime(*at)) {
    return std::nullopt;
  }
  Fault fault{.kind = kind, .servo = static_cast<std::size_t>(*servo), .at = FromSeconds(*at)};
  if (const std::optional<double> lasts = TakeNumberAfter('+', rest)) {
    if (!IsTime(*lasts)) return std::nullopt;
    fault.lasts = FromSeconds(*lasts);
  }
  const std::optional<double> value = TakeNumberAfter('=', rest);
  fault.value = value.value_or(0);
  const bool needs_value =
      kind == FaultKind::kJam || kind == FaultKind::kHot || kind == FaultKind::kJump;
  if (!rest.empty() || needs_value != value.has_value()) return std::nullopt;
  return fault;
}

}  // namespace

std::optional<std::string> AddFault(std::string_view text, FaultPlan& plan) {
  const std::string_view name = text.substr(0, text.find_first_of(":="));
  std::string_view rest = text.substr(name.size());
  for (const Rate& rate : kRates) {
    if (name != rate.name) continue;
    const std::optional<double> value = TakeNumberAfter('=', rest);
    if (!value || !rest.empty() || *value < 0 || *value > rate.most) {
      return "fault '" + std::string(text) + "': " + rate.name + "= needs a number from 0 to " +
             std::to_string(static_cast<int>(rate.most));
    }
    plan.line.*rate.value = *value;
    return std::nullopt;
  }
  for (std::size_t kind = 0; kind < kFaultKinds; ++kind) {
    if (name != kFaultNames[kind]) continue;
    const std::optional<Fault> fault = ParseFault(static_cast<FaultKind>(kind), rest);
    if (!fault) {
      return "fault '" + std::string(text) + "': write " + std::string(name) +
             ":SERVO@START[+LASTS][=VALUE], in seconds; jam, hot and jump have a value";
    }
    plan.faults.push_back(*fault);
    return std::nullopt;
  }
  return "fault '" + std::string(text) +
         "': there are lose, flip, duplicate, late, late-ms, noise, vanish, mute, brownout, jam, "
         "hot and jump";
}

std::vector<Fault> RandomFaults(std::uint64_t seed, std::size_t servos, Duration total,
                                double per_minute, double low, double high) {
  Random random(seed);
  std::vector<Fault> faults;
  const double total_s = std::chrono::duration<double>(total).count();
  for (auto left = static_cast<std::size_t>(total_s / 60 * per_minute); left > 0; --left) {
    Fault fault{.kind = static_cast<FaultKind>(random.Next() % kFaultKinds),
                .servo = static_cast<std::size_t>(random.Next() % servos),
                .at = FromSeconds(random.Between(0, total_s)),
                .lasts = FromSeconds(random.Between(0.02, 3))};
    if (fault.kind == FaultKind::kJam) fault.value = random.Between(low, high);
    if (fault.kind == FaultKind::kHot) fault.value = random.Between(40, 90);
    if (fault.kind == FaultKind::kJump) fault.value = random.Between(-0.1, 0.1) * (high - low);
    faults.push_back(fault);
  }
  std::sort(faults.begin(), faults.end(),
            [](const Fault& a, const Fault& b) { return a.at < b.at; });
  return faults;
}

}  // namespace facewire::sim
