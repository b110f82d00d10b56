#include "app/animatronic/servo_watch.h"

#include <algorithm>
#include <cstdio>
#include <span>
#include <utility>

#include "app/animatronic/servo_words.h"

namespace facewire::app {
namespace {

using Text = std::array<char, 800>;

const char* Chars(const ShortName& name, std::array<char, kMaxNameLength + 1>& out) noexcept {
  const std::size_t size = name.view().copy(out.data(), kMaxNameLength);
  out[size] = '\0';
  return out.data();
}

}  // namespace

ServoWatch::ServoWatch(Journal& journal, const servo::ServoRig& rig,
                       std::vector<ServoBusConfig> buses)
    : journal_(journal), rig_(rig), buses_(std::move(buses)) {}

const ServoBusConfig& ServoWatch::BusOf(std::size_t servo) const noexcept {
  return *std::ranges::find(buses_, rig_.servos[servo].bus.view(), &ServoBusConfig::name);
}

ServoWatch::BusNews ServoWatch::NewsOf(const ServoReport::Bus& bus) noexcept {
  if (bus.port == PortState::kClosed) return BusNews::kLost;
  if (bus.port == PortState::kStuck) return BusNews::kStuck;
  if (bus.fault == bus::BusFault::kNobodyAnswers) return BusNews::kNobody;
  return bus.fault == bus::BusFault::kEcho ? BusNews::kEcho : BusNews::kNone;
}

ServoWatch::ServoNews ServoWatch::NewsOf(const bus::ServoFeedback& feedback) noexcept {
  if (feedback.state == bus::ServoState::kAbsent) return ServoNews::kAbsent;
  if (feedback.state == bus::ServoState::kRefused) return ServoNews::kRefused;
  const bool gone = feedback.factor <= 0;
  switch (feedback.reason) {
    case bus::Reason::kHeat:
      return gone ? ServoNews::kLetGoByHeat : ServoNews::kSlowedByHeat;
    case bus::Reason::kLoad:
      return gone ? ServoNews::kLetGoByLoad : ServoNews::kSlowedByLoad;
    case bus::Reason::kHardware:
      return ServoNews::kHardware;
    default:
      return ServoNews::kNone;
  }
}

void ServoWatch::Look(const ServoReport& report, bool powered, Time now) noexcept {
  for (std::size_t i = 0; i < report.bus_count; ++i) {
    const BusNews news = NewsOf(report.buses[i]);
    const bool silence = news == BusNews::kNobody;
    if (news == told_buses_[i] || (silence && !powered)) continue;
    told_buses_[i] = news;
    TellBus(i, news);
  }
  for (std::size_t i = 0; i < report.servo_count; ++i) {
    Told& told = servos_[i];
    const ServoNews news = NewsOf(report.servos[i].feedback);
    // Without power, or on a bus that is gone as a whole, silence is not the servo's.
    const auto bus = static_cast<std::size_t>(&BusOf(i) - buses_.data());
    const bool excused =
        news == ServoNews::kAbsent && (!powered || told_buses_[bus] != BusNews::kNone);
    if (news != told.seen || excused) {
      told.seen = news;
      told.since = now;
    }
    if (news == told.told || excused || now - told.since < kSettled) continue;
    told.told = news;
    TellServo(i, news, report);
  }
  TellFindings(report);
}

void ServoWatch::TellBus(std::size_t bus, BusNews news) noexcept {
  const ServoBusConfig& config = buses_[bus];
  const char* what = "is well again";
  switch (news) {
    case BusNews::kNone:
      break;
    case BusNews::kLost:
      what = "its port is gone; it is tried again";
      break;
    case BusNews::kStuck:
      what = "its port takes no bytes";
      break;
    case BusNews::kNobody:
      what = "nobody answers; are the servos powered, and is this the baud rate?";
      break;
    case BusNews::kEcho:
      what = "the adapter gives back what is sent; its receiver must be off while it sends";
      break;
  }
  Text text;
  (void)std::snprintf(text.data(), text.size(), "bus %s (%s, %d baud): %s", config.name.c_str(),
                      config.port.c_str(), config.baud, what);
  journal_.Write(Event::kServoBus, text.data());
}

void ServoWatch::TellServo(std::size_t servo, ServoNews news, const ServoReport& report) noexcept {
  const bus::ServoFeedback& feedback = report.servos[servo].feedback;
  const ServoBusConfig& bus = BusOf(servo);
  const auto heat = static_cast<double>(feedback.temperature_c.value_or(0));
  const auto hot = static_cast<double>(bus.guard.hot_c);
  const auto cool = static_cast<double>(bus.guard.cool_c);
  const double load = 100 * std::abs(static_cast<double>(feedback.load.value_or(0)));
  std::array<char, 200> what;
  const auto say = [&what](const char* format, auto... values) {
    (void)std::snprintf(what.data(), what.size(), format, values...);
  };
  switch (news) {
    case ServoNews::kNone:
      say("%s", "is well again");
      break;
    case ServoNews::kAbsent:
      say("%s", "does not answer");
      break;
    case ServoNews::kRefused:
      return;  // by its finding, below
    case ServoNews::kSlowedByHeat:
      say("is hot, %.0f degrees Celsius, and slowed down; at %.0f it is let go", heat, hot);
      break;
    case ServoNews::kLetGoByHeat:
      say("is too hot, %.0f degrees Celsius: let go until it has %.0f", heat, cool);
      break;
    case ServoNews::kSlowedByLoad:
      say("works hard, %.0f %% of what it can do, and is slowed down", load);
      break;
    case ServoNews::kLetGoByLoad:
      say("worked too hard for too long, %.0f %%: let go for a rest; does something block it?",
          load);
      break;
    case ServoNews::kHardware:
      say("reports %s and is let go", FaultWords(feedback.faults).data());
      break;
  }
  std::array<char, kMaxNameLength + 1> name;
  Text text;
  (void)std::snprintf(text.data(), text.size(), "servo %s (bus %s, id %u): %s",
                      Chars(rig_.servos[servo].name, name), bus.name.c_str(),
                      static_cast<unsigned>(rig_.servos[servo].id), what.data());
  journal_.Write(Event::kServo, text.data());
}

void ServoWatch::TellFindings(const ServoReport& report) noexcept {
  for (const bus::Finding& finding : report.findings) {
    const auto bit = static_cast<std::uint16_t>(1U << static_cast<unsigned>(finding.setting));
    if (!finding.refused || (servos_[finding.servo].settings & bit) != 0) continue;
    servos_[finding.servo].settings |= bit;
    std::array<char, kMaxNameLength + 1> name;
    (void)Chars(rig_.servos[finding.servo].name, name);
    const char* word = SettingWord(finding.setting);
    std::array<char, 240> command{};
    if (*word != '\0') {
      (void)std::snprintf(command.data(), command.size(), ": facewire servo set %s %s %s",
                          name.data(), word,
                          SettingArgument(finding.setting, finding.wanted).data());
    }
    Text text;
    (void)std::snprintf(
        text.data(), text.size(), "servo %s (bus %s, id %u): its %s is %s and should be %s%s%s",
        name.data(), BusOf(finding.servo).name.c_str(),
        static_cast<unsigned>(rig_.servos[finding.servo].id), bus::Name(finding.setting),
        SettingWords(finding.setting, finding.found).data(),
        SettingWords(finding.setting, finding.wanted).data(),
        finding.refused ? "; it is left limp until then" : "", command.data());
    journal_.Write(Event::kServo, text.data());
  }
}

}  // namespace facewire::app
