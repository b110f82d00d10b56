#include "app/status_report.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "app/animatronic/servo_words.h"
#include "app/report.h"

namespace facewire::app {
namespace {

// Writes JSON into a fixed text.
class Json {
 public:
  explicit Json(std::array<char, kMaxReportBytes>& out) noexcept : out_(out) { Begin('{'); }

  Json& Text(const char* key, std::string_view value) noexcept {
    Key(key);
    Put('"');
    for (const char c : value) {
      if (c == '"' || c == '\\') Put('\\');
      Put(static_cast<unsigned char>(c) < 0x20 ? ' ' : c);
    }
    Put('"');
    return *this;
  }
  Json& Count(const char* key, std::uint64_t value) noexcept {
    return Number(key, static_cast<double>(value), 0);
  }
  Json& Number(const char* key, double value, int decimals) noexcept {
    Key(key);
    std::array<char, 40> text;
    (void)std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    for (const char* c = text.data(); *c != '\0'; ++c) Put(*c);
    return *this;
  }
  // What nobody knows is left out.
  Json& Number(const char* key, const std::optional<float>& value, int decimals) noexcept {
    return value ? Number(key, static_cast<double>(*value), decimals) : *this;
  }
  // An array of objects, each begun by Next.
  void Array(const char* key) noexcept {
    Key(key);
    Begin('[');
  }
  Json& Next() noexcept {
    Comma();
    Begin('{');
    return *this;
  }
  void End(char bracket) noexcept {
    Put(bracket);
    first_ = false;
  }

 private:
  void Begin(char bracket) noexcept {
    Put(bracket);
    first_ = true;
  }
  void Comma() noexcept {
    if (!first_) Put(',');
    first_ = false;
  }
  void Key(const char* key) noexcept {
    Comma();
    Put('"');
    for (; *key != '\0'; ++key) Put(*key);
    Put('"');
    Put(':');
  }
  void Put(char c) noexcept {
    if (size_ + 1 < out_.size()) out_[size_++] = c;
  }

  std::array<char, kMaxReportBytes>& out_;
  std::size_t size_ = 0;
  bool first_ = true;
};

void AddBuses(const StatusReport& report, const ServoReport& now, Json& o) noexcept {
  o.Array("buses");
  for (std::size_t i = 0; i < std::min<std::size_t>(now.bus_count, report.buses.size()); ++i) {
    const ServoBusConfig& bus = report.buses[i];
    const ServoReport::Bus& b = now.buses[i];
    o.Next().Text("name", bus.name).Text("kind", Name(bus.kind)).Text("port", bus.port);
    o.Text("port_state", Name(b.port)).Text("state", bus::Name(b.state));
    o.Text("fault", b.fault == bus::BusFault::kNone ? "" : bus::Name(b.fault));
    o.Count("bytes_out", b.counters.bytes_out).Count("bytes_in", b.counters.bytes_in);
    o.Count("losses", b.counters.losses).Count("reopens", b.counters.reopens);
    o.Count("questions", b.questions).Count("lost", b.lost);
    o.Count("torque_lost", b.torque_lost).Count("serial_errors", b.serial_errors);
    o.End('}');
  }
  o.End(']');
}

void AddServos(const StatusReport& report, const ServoReport& now, Json& o) noexcept {
  o.Array("servos");
  for (std::size_t i = 0; i < now.servo_count; ++i) {
    const servo::Servo& servo = report.servos->servos[i];
    const servo::Command& command = now.servos[i].command;
    const bus::ServoFeedback& feedback = now.servos[i].feedback;
    o.Next().Text("name", servo.name.view()).Text("bus", servo.bus.view()).Count("id", servo.id);
    o.Text("state", bus::Name(feedback.state)).Text("activity", Name(command.activity));
    o.Text("torque", feedback.torque ? "on" : "off");
    o.Number("commanded", static_cast<double>(command.position), 2);
    o.Number("position", feedback.position, 2);
    o.Number("temperature_c", feedback.temperature_c, 0);
    o.Number("load", feedback.load, 2).Number("voltage_v", feedback.voltage_v, 1);
    o.Number("factor", static_cast<double>(feedback.factor), 2);
    o.Text("reason", feedback.reason == bus::Reason::kNone ? "" : bus::Name(feedback.reason));
    o.Text("faults", feedback.faults == 0 ? "" : FaultWords(feedback.faults, ",").data());
    o.Count("lost", feedback.lost).End('}');
  }
  o.End(']');
}

const char* Name(WatchedCamera::Health camera) noexcept {
  switch (camera) {
    case WatchedCamera::Health::kUp:
      return "up";
    case WatchedCamera::Health::kSilent:
      return "silent";
    case WatchedCamera::Health::kGone:
      break;
  }
  return "gone";
}

const char* Name(Service::NeutralKind kind) noexcept {
  switch (kind) {
    case Service::NeutralKind::kNone:
      return "none";
    case Service::NeutralKind::kProvisional:
      return "provisional";
    case Service::NeutralKind::kNotKept:
      return "not kept";
    case Service::NeutralKind::kKept:
      break;
  }
  return "kept";
}

}  // namespace

std::array<char, kMaxReportBytes> ToJson(const StatusReport& report) noexcept {
  const Service& service = report.service;
  const wire::Status& status = service.status();
  const ServiceStats& stats = service.stats();
  const HostLineCounters& line = report.line.counters();
  std::array<char, kMaxReportBytes> text{};
  Json o(text);
  o.Text("version", FACEWIRE_VERSION);
  o.Text("state", facewire::Name(service.state())).Text("reason", service.reason());
  o.Text("ailment", service.Ailment()).Count("uptime_s", status.uptime_s);
  o.Number("fps", status.centi_fps / 100.0, 2);
  o.Number("latency_p50_ms", status.latency_p50_us / 1000.0, 1);
  o.Number("latency_p99_ms", status.latency_p99_us / 1000.0, 1);
  o.Count("frames", stats.frames).Count("frames_dropped", stats.frames_dropped);
  o.Count("losses", stats.losses);
  o.Text("camera", report.camera_address).Text("camera_state", Name(service.camera()));
  o.Count("camera_restarts", stats.camera_restarts);
  const bool stuck = report.line.TakesNothingFor() > std::chrono::seconds(1);
  o.Text("line", report.line_address);
  o.Text("line_state", report.line_address.empty() ? "none"
                       : !report.line.connected()  ? "gone"
                       : stuck                     ? "takes nothing"
                                                   : "up");
  o.Count("poses_sent", line.poses).Count("poses_dropped", line.poses_dropped);
  o.Count("line_bytes", line.bytes);
  o.Count("line_errors", line.write_errors).Count("line_losses", line.hang_ups);
  o.Count("line_reopens", line.opens > 0 ? line.opens - 1 : 0);
  o.Text("neutral", Name(service.neutral_kind())).Text("state_folder", report.state_folder);
  o.Text("storage_problem", report.storage_problem).Text("stop_problem", report.stop_problem);
  o.Count("commands", stats.commands);
  o.Number("searching_after_s", static_cast<double>(Seconds(report.searching_after)), 2);
  o.Count("resident_bytes", ResidentBytes()).Count("threads", ThreadCount());
  if (const ServoReport* servos = service.servos(); servos != nullptr) {
    o.Count("servo_ticks", servos->ticks).Count("servo_ticks_late", servos->late);
    AddBuses(report, *servos, o);
    AddServos(report, *servos, o);
  }
  o.End('}');
  return text;
}

}  // namespace facewire::app
