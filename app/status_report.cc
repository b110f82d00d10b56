#include "app/status_report.h"

#include <cstdio>

#include "app/report.h"

namespace facewire::app {
namespace {

class Object {
 public:
  explicit Object(std::array<char, kMaxReportBytes>& out) noexcept : out_(out) {}

  Object& Text(const char* key, std::string_view value) noexcept {
    Key(key);
    Put('"');
    for (const char c : value) {
      if (c == '"' || c == '\\') Put('\\');
      Put(static_cast<unsigned char>(c) < 0x20 ? ' ' : c);
    }
    Put('"');
    return *this;
  }
  Object& Count(const char* key, std::uint64_t value) noexcept {
    return Number(key, static_cast<double>(value), 0);
  }
  Object& Number(const char* key, double value, int decimals) noexcept {
    Key(key);
    std::array<char, 40> text;
    (void)std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    for (const char* c = text.data(); *c != '\0'; ++c) Put(*c);
    return *this;
  }
  void Done() noexcept { Put('}'); }

 private:
  void Key(const char* key) noexcept {
    Put(size_ == 0 ? '{' : ',');
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
};

const char* Name(Service::Camera camera) noexcept {
  switch (camera) {
    case Service::Camera::kUp:
      return "up";
    case Service::Camera::kSilent:
      return "silent";
    case Service::Camera::kGone:
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
  Object o(text);
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
                       : stuck                     ? "stuck"
                                                   : "up");
  o.Count("poses_sent", line.poses).Count("poses_dropped", line.poses_dropped);
  o.Count("line_errors", line.write_errors).Count("line_losses", line.hang_ups);
  o.Text("neutral", Name(service.neutral_kind())).Text("state_folder", report.state_folder);
  o.Text("storage_problem", report.storage_problem).Text("stop_problem", report.stop_problem);
  o.Count("commands", stats.commands);
  o.Number("searching_after_s", static_cast<double>(Seconds(report.searching_after)), 2);
  o.Count("resident_bytes", ResidentBytes()).Count("threads", ThreadCount());
  o.Done();
  return text;
}

}  // namespace facewire::app
