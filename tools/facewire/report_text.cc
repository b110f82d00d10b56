#include "tools/facewire/report_text.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <vector>

#include "tools/facewire/json_reader.h"

namespace facewire::tools {
namespace {

using Members = std::map<std::string, std::string, std::less<>>;
struct Report {
  Members members;
  std::map<std::string, std::vector<Members>, std::less<>> lists;  // of objects
};

std::string Unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size()) ++i;
    plain += text[i];
  }
  return plain;
}

std::string Shown(double number) {
  std::array<char, 40> text;
  (void)std::snprintf(text.data(), text.size(), "%.10g", number);
  return text.data();
}

// A number or text of an object; false when it is neither.
bool ReadMember(json::Reader& reader, std::string_view key, Members& members) {
  if (const auto number = reader.Number()) {
    members.emplace(key, Shown(*number));
  } else if (const auto words = reader.String()) {
    members.emplace(key, Unescaped(*words));
  } else {
    return false;
  }
  return true;
}

std::optional<Members> ReadFlat(json::Reader& reader) {
  Members members;
  if (!reader.Take('{')) return std::nullopt;
  do {
    const auto key = reader.String();
    if (!key || !reader.Take(':')) return std::nullopt;
    if (!ReadMember(reader, *key, members) && !reader.Skip()) return std::nullopt;
  } while (reader.Take(','));
  if (!reader.Take('}')) return std::nullopt;
  return members;
}

// False when it is no array of objects.
bool ReadList(json::Reader& reader, std::vector<Members>& list) {
  if (!reader.Take('[')) return false;
  if (reader.Take(']')) return true;
  do {
    const auto members = ReadFlat(reader);
    if (!members) return false;
    list.push_back(*members);
  } while (reader.Take(','));
  return reader.Take(']');
}

std::optional<Report> Read(std::string_view text) {
  json::Reader reader(text);
  Report report;
  if (!reader.Take('{')) return std::nullopt;
  do {
    const auto key = reader.String();
    if (!key || !reader.Take(':')) return std::nullopt;
    if (ReadMember(reader, *key, report.members)) continue;
    if (*key == "buses" || *key == "servos") {
      if (!ReadList(reader, report.lists[std::string(*key)])) return std::nullopt;
    } else if (!reader.Skip()) {
      return std::nullopt;
    }
  } while (reader.Take(','));
  if (!reader.Take('}') || !reader.AtEnd()) return std::nullopt;
  return report;
}

std::string ValueOf(const Members& members, std::string_view key) {
  const auto found = members.find(key);
  return found == members.end() ? "?" : found->second;
}

// One column of a table of servos: as wide as it needs, "-" where a servo does not tell.
std::string Column(const Members& servo, std::string_view key, std::size_t width,
                   std::string_view unit) {
  std::string text = servo.contains(key) ? ValueOf(servo, key) + std::string(unit) : "-";
  if (text.size() < width) text.insert(0, width - text.size(), ' ');
  return text;
}

std::string BusLines(const Report& report) {
  std::string text;
  const auto buses = report.lists.find("buses");
  if (buses == report.lists.end()) return text;
  for (const Members& bus : buses->second) {
    const std::string fault = ValueOf(bus, "fault");
    text += "bus      " + ValueOf(bus, "name") + ": " + ValueOf(bus, "kind") + ", " +
            ValueOf(bus, "port") + ": " + ValueOf(bus, "port_state") + ", " +
            ValueOf(bus, "state") + (fault.empty() || fault == "?" ? "" : ": " + fault) + ", " +
            ValueOf(bus, "questions") + " questions, " + ValueOf(bus, "lost") +
            " without an answer, lost " + ValueOf(bus, "losses") + " times\n";
  }
  return text;
}

std::string ServoLines(const Report& report) {
  std::string text;
  const auto servos = report.lists.find("servos");
  if (servos == report.lists.end()) return text;
  for (const Members& servo : servos->second) {
    std::string name =
        ValueOf(servo, "name") + " (" + ValueOf(servo, "bus") + " " + ValueOf(servo, "id") + ")";
    if (name.size() < 24) name.resize(24, ' ');
    std::string state = ValueOf(servo, "state") + ", " + ValueOf(servo, "activity");
    if (state.size() < 20) state.resize(20, ' ');
    text += "servo    " + name + " " + state + " at" + Column(servo, "position", 8, "") + ", told" +
            Column(servo, "commanded", 8, "") + Column(servo, "temperature_c", 6, " C") + ", load" +
            Column(servo, "load", 6, "") + Column(servo, "voltage_v", 7, " V");
    for (const char* key : {"reason", "faults"}) {
      const std::string words = ValueOf(servo, key);
      if (!words.empty() && words != "?") text += ", " + words;
    }
    text += "\n";
  }
  return text;
}

// "1 h 5 min", "5 min 3 s", "3 s"
std::string TimeText(const std::string& seconds) {
  const auto s = std::strtoull(seconds.c_str(), nullptr, 10);
  if (s >= 3600) return std::to_string(s / 3600) + " h " + std::to_string(s / 60 % 60) + " min";
  if (s >= 60) return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
  return std::to_string(s) + " s";
}

}  // namespace

std::optional<std::string> ReportText(std::string_view json) {
  const auto report = Read(json);
  if (!report) return std::nullopt;
  const auto get = [&](std::string_view key) { return ValueOf(report->members, key); };
  const auto after = [&](const char* mark, std::string_view key) -> std::string {
    const std::string words = get(key);
    return words.empty() || words == "?" ? "" : mark + words;
  };
  std::string text = get("state") + after(": ", "reason") + "\n";
  if (const std::string ailment = after("", "ailment"); !ailment.empty()) {
    text += "ill      " + ailment + "; the watchdog is no longer fed\n";
  }
  text += "camera   " + get("camera") + ": " + get("camera_state") + ", " + get("fps") +
          " frames a second, " + get("frames") + " in all, " + get("frames_dropped") +
          " dropped, " + get("camera_restarts") + " restarts\n";
  text += "latency  " + get("latency_p50_ms") + " ms, 99 %: " + get("latency_p99_ms") + " ms\n";
  if (get("line_state") == "none") {
    text += "line     none\n";
  } else {
    text += "line     " + get("line") + ": " + get("line_state") + ", " + get("poses_sent") +
            " poses, " + get("poses_dropped") + " not taken, " + get("line_bytes") + " bytes, " +
            get("line_errors") + " errors, lost " + get("line_losses") + " times, opened again " +
            get("line_reopens") + " times\n";
  }
  text += BusLines(*report) + ServoLines(*report);
  text += "face     lost " + get("losses") + " times\n";
  text += "neutral  " + get("neutral") + ", in " + get("state_folder") + "\n";
  if (const std::string problem = after("", "storage_problem"); !problem.empty()) {
    text += "storage  nothing outlasts a loss of power: " + problem + "\n";
  }
  if (const std::string problem = after("", "stop_problem"); !problem.empty()) {
    text += "stop     " + problem + "\n";
  }
  const double mib = std::strtod(get("resident_bytes").c_str(), nullptr) / (1024 * 1024);
  std::array<char, 32> memory;
  (void)std::snprintf(memory.data(), memory.size(), "%.1f MiB", mib);
  text += "process  up " + TimeText(get("uptime_s")) + ", " + memory.data() + ", " +
          get("threads") + " threads, facewired " + get("version");
  const std::string after_s = get("searching_after_s");
  text += after_s == "0" || after_s == "?" ? "\n" : ", was searching after " + after_s + " s\n";
  return text;
}

}  // namespace facewire::tools
