#include "app/observer.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "app/report.h"

namespace facewire::app {

void Observer::Look(const Service& service, Time now) noexcept {
  const ServiceState state = service.state();
  journal_.SetState(Name(state));
  Feed(service, now);
  if (searching_after_ == Duration::zero() && state == ServiceState::kSearching) {
    searching_after_ = ProcessAge();
    std::array<char, 80> text;
    (void)std::snprintf(text.data(), text.size(), "searching after %.2f s",
                        static_cast<double>(Seconds(searching_after_)));
    journal_.Write(Event::kSearching, text.data());
    told_ = state;
  }
  if (now < next_look_) return;
  next_look_ = now + std::chrono::seconds(1);
  TellSystemd(service);
  TellState(service);
}

void Observer::Feed(const Service& service, Time now) noexcept {
  const std::string_view ailment = service.Ailment();
  if (starving_ == ailment.empty()) {
    starving_ = !ailment.empty();
    if (starving_) {
      journal_.Write(Event::kStarving, "only a restart may still help: the watchdog is not fed",
                     ailment);
    } else {
      journal_.Write(Event::kRecovered, "the watchdog is fed again");
    }
  }
  if (starving_ || supervisor_.watchdog_interval() == Duration::zero() || now < next_beat_) return;
  next_beat_ = now + supervisor_.watchdog_interval();
  supervisor_.Alive();
}

void Observer::TellState(const Service& service) noexcept {
  const ServiceState state = service.state();
  if (state == told_) return;
  told_ = state;
  const char* reason = service.reason();
  std::array<char, 200> text;
  (void)std::snprintf(text.data(), text.size(), "%s%s%s", Name(state), *reason == '\0' ? "" : ": ",
                      reason);
  const bool stopped = state == ServiceState::kStopped;
  journal_.Write(stopped                         ? Event::kStopped
                 : state == ServiceState::kFault ? Event::kFault
                                                 : Event::kState,
                 text.data(), reason);
  if (stopped && !latch_.reason().empty()) {
    journal_.Write(Event::kStopNotKept, latch_.reason());
  }
}

void Observer::TellSystemd(const Service& service) noexcept {
  const wire::Status& status = service.status();
  const char* ailment = service.Ailment();
  const char* reason = *ailment != '\0' ? ailment : service.reason();
  std::array<char, 48> damage{};  // said where there is any: a bad cable, a crowded USB bus
  if (const std::uint64_t pictures = service.stats().frames_damaged; pictures > 0) {
    (void)std::snprintf(damage.data(), damage.size(), ", %llu damaged pictures",
                        static_cast<unsigned long long>(pictures));
  }
  std::array<char, 240> text;
  const int size = std::snprintf(text.data(), text.size(), "%s%s%s, %d.%d fps%s, latency %u ms%s",
                                 Name(service.state()), *reason == '\0' ? "" : ": ", reason,
                                 status.centi_fps / 100, status.centi_fps / 10 % 10, damage.data(),
                                 static_cast<unsigned>(status.latency_p50_us / 1000),
                                 service.neutral_kind() == Service::NeutralKind::kNotKept
                                     ? ", the neutral is kept only until the restart"
                                     : "");
  supervisor_.Status({text.data(), std::min(static_cast<std::size_t>(size), text.size() - 1)});
}

}  // namespace facewire::app
