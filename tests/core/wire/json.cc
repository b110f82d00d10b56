#include "tests/core/wire/json.h"

#include <cstdio>
#include <string_view>
#include <variant>
#include <vector>

namespace facewire::wire {
namespace {

// Names, states and descriptions here are ASCII; only quotes and backslashes need care.
std::string Quote(std::string_view text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

class Object {
 public:
  Object& Raw(const char* key, const std::string& value) {
    text_ += (text_.empty() ? "" : ", ") + Quote(key) + ": " + value;
    return *this;
  }
  template <class T>
  Object& Int(const char* key, T value) {
    return Raw(key, std::to_string(value));
  }
  Object& Text(const char* key, std::string_view value) { return Raw(key, Quote(value)); }
  Object& Float(const char* key, float value) { return Raw(key, Number(value)); }
  Object& At(const char* key, Time t) { return Int(key, t.time_since_epoch().count()); }

  static std::string Number(float value) {
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
    // A number that looks whole would be read as an integer, which has no -0.
    const std::string_view digits = text;
    return std::string(digits) + (digits.find_first_of(".e") == digits.npos ? ".0" : "");
  }
  template <class Values>
  Object& List(const char* key, const Values& values) {
    std::string list;
    for (const auto value : values) list += (list.empty() ? "" : ", ") + std::to_string(value);
    return Raw(key, "[" + list + "]");
  }
  std::string Done() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

struct AddFields {
  Object& o;

  void operator()(const RigHeader& m) const {
    o.Text("type", "rig_header").Int("rig_id", m.rig_id).Int("bones", m.bones);
    o.Int("channels", m.channels).Text("name", m.name.view());
  }
  void operator()(const BoneDescription& m) const {
    o.Text("type", "bone").Int("rig_id", m.rig_id).Int("index", m.index);
    o.Raw("rest_cm", "[" + Object::Number(m.rest_cm.x) + ", " + Object::Number(m.rest_cm.y) + ", " +
                         Object::Number(m.rest_cm.z) + "]");
    o.Text("name", m.name.view());
  }
  void operator()(const ChannelDescription& m) const {
    o.Text("type", "channel").Int("rig_id", m.rig_id).Int("index", m.index);
    o.Text("kind", Name(m.kind)).Int("bone", m.bone);
    o.Float("neutral", m.neutral).Float("min", m.min).Float("max", m.max);
    o.Text("name", m.name.view());
  }
  void operator()(const Pose& m) const {
    o.Text("type", "pose").Int("rig_id", m.rig_id).Int("frame_seq", m.frame_seq);
    o.At("captured_us", m.captured).Int("age_us", m.age_us).Int("state", static_cast<int>(m.state));
    o.List("steps", m.values);
  }
  void operator()(const Status& m) const {
    o.Text("type", "status").Int("rig_id", m.rig_id).Int("state", static_cast<int>(m.state));
    o.At("now_us", m.now).Int("uptime_s", m.uptime_s).Int("centi_fps", m.centi_fps);
    o.Int("frames", m.frames).Int("dropped", m.dropped).Int("losses", m.losses);
    o.Int("link_errors", m.link_errors).Int("latency_p50_us", m.latency_p50_us);
    o.Int("latency_p99_us", m.latency_p99_us);
  }
  void operator()(const Acknowledgement& m) const {
    o.Text("type", "acknowledgement").Int("id", m.id).Int("code", static_cast<int>(m.code));
    o.Int("result", static_cast<int>(m.result)).At("now_us", m.now);
    if (HasMeasure(m.result)) o.Float("measure", m.measure);
  }
  void operator()(const Text& m) const {
    o.Text("type", "text").Int("id", m.id);
    o.Text("text", {m.text.begin(), m.text.size()});
  }
  void operator()(const ServoSetup& m) const {
    o.Text("type", "servo_setup").Int("setup_id", m.setup_id).Int("hold_ms", m.hold_ms);
    o.Int("ease_ms", m.ease_ms).Int("release_ms", m.release_ms);
    std::string servos;
    for (const ServoLimits& s : m.servos) {
      Object servo;
      servo.Int("min", s.min_quarter_us).Int("neutral", s.neutral_quarter_us);
      servo.Int("max", s.max_quarter_us).Int("speed", s.speed_us_s);
      servo.Int("ramp_speed", s.ramp_speed_us_s);
      servo.Int("ramp_acceleration", s.ramp_acceleration_10us_s2);
      servos += (servos.empty() ? "" : ", ") + servo.Done();
    }
    o.Raw("servos", "[" + servos + "]");
  }
  void operator()(const ServoPulses& m) const {
    o.Text("type", "servo_pulses").Int("setup_id", m.setup_id).Int("stop", m.stop ? 1 : 0);
    o.List("quarter_us", m.quarter_us);
  }
  void operator()(const LandmarkPart& m) const {
    o.Text("type", "landmarks").Int("frame_seq", m.frame_seq).At("captured_us", m.captured);
    o.Int("width_px", m.width_px).Int("height_px", m.height_px);
    o.Int("total", m.total).Int("first", m.first);
    std::vector<int> flat;
    for (const LandmarkPoint& p : m.points) {
      flat.insert(flat.end(), {p.x_eighth_px, p.y_eighth_px});
    }
    o.List("eighth_px", flat);
  }
  void operator()(const ReceiverStatus& m) const {
    o.Text("type", "receiver_status").Int("setup_id", m.setup_id);
    o.Int("state", static_cast<int>(m.state)).Int("capacity", m.capacity);
    o.Int("version_major", m.version_major).Int("version_minor", m.version_minor);
    o.Int("reset_causes", m.reset_causes).Int("supply_mv", m.supply_mv);
    o.Int("uptime_ms", m.uptime_ms).Int("frames", m.frames).Int("damaged", m.damaged);
    o.Int("lost", m.lost).Int("refused", m.refused).List("quarter_us", m.quarter_us);
  }
  void operator()(const Command& m) const {
    o.Text("type", "command").Int("id", m.id).Int("code", static_cast<int>(m.code));
    if (TakesValue(m.code)) o.Float("value", m.value);
    if (TakesItem(m.code)) o.Int("item", m.item);
  }
};

}  // namespace

std::string ToJson(const Received& received) {
  Object o;
  o.Int("sequence", received.sequence);
  std::visit(AddFields{o}, received.message);
  return o.Done();
}

std::string ToJson(const LinkStats& s) {
  Object o;
  o.Int("frames", s.frames).Int("unknown", s.unknown).Int("versions", s.versions);
  o.Int("malformed", s.malformed).Int("crc_errors", s.crc_errors);
  o.Int("cobs_errors", s.cobs_errors).Int("truncated", s.truncated).Int("overflows", s.overflows);
  o.Int("lost", s.lost).Int("restarts", s.restarts).Int("resyncs", s.resyncs);
  return o.Done();
}

std::string DecodeToJson(const std::string& about, std::span<const std::byte> stream) {
  Decoder decoder;
  std::string messages;
  for (;;) {
    const auto received = decoder.Next(stream);
    if (received) {
      messages += (messages.empty() ? "\n    " : ",\n    ") + ToJson(*received);
    } else if (received.error() == Errc::kNotReady) {
      break;
    }
  }
  return "{\n  \"about\": " + Quote(about) + ",\n  \"messages\": [" + messages +
         (messages.empty() ? "" : "\n  ") + "],\n  \"stats\": " + ToJson(decoder.stats()) + "\n}\n";
}

}  // namespace facewire::wire
