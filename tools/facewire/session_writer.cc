#include "tools/facewire/session_writer.h"

#include "app/error.h"
#include "tools/facewire/json.h"
#include "tools/markers/head_motion.h"

namespace facewire::tools {
namespace {

// A ten-thousandth of a millimetre: rounding stays far below what any marker system resolves.
constexpr int kDecimals = 5;

const std::string& Checked(const std::string& path) {
  if (!path.ends_with(".csv") && !path.ends_with(".jsonl"))
    throw app::BadInput("--out " + path + ": a name that ends in .csv or .jsonl would be right");
  return path;
}

}  // namespace

SessionWriter::SessionWriter(const std::string& path)
    : out_(Checked(path)), json_(path.ends_with(".jsonl")) {}

void SessionWriter::Write(const SessionFrame& frame, const std::vector<std::string>& names) {
  if (json_) {
    WriteJson(frame, names);
  } else {
    WriteCsv(frame, names);
  }
}

void SessionWriter::WriteJson(const SessionFrame& frame, const std::vector<std::string>& names) {
  std::string line = "{\"frame\":" + std::to_string(frame.frame) +
                     ",\"t_us\":" + std::to_string(frame.t_us) + ",\"markers\":";
  for (std::size_t i = 0; i < names.size(); ++i) {
    line += i == 0 ? '{' : ',';
    json::AppendString(line, names[i]);
    line += ':';
    const Point3 p = frame.points_cm[i];
    if (!markers::Seen(p)) {
      line += "null";
      continue;
    }
    char separator = '[';
    for (const float v : {p.x, p.y, p.z}) {
      line += separator;
      json::AppendNumber(line, static_cast<double>(v), kDecimals);
      separator = ',';
    }
    line += ']';
  }
  out_.Write(line + "}}\n");
}

void SessionWriter::WriteCsv(const SessionFrame& frame, const std::vector<std::string>& names) {
  std::string line;
  if (!has_header_) {
    line = "frame,t_us";
    for (const std::string& name : names) {
      for (const char* axis : {"_x", "_y", "_z"}) line.append(",").append(name).append(axis);
    }
    line += '\n';
    has_header_ = true;
  }
  line += std::to_string(frame.frame) + "," + std::to_string(frame.t_us);
  for (const Point3& p : frame.points_cm) {
    for (const float v : {p.x, p.y, p.z}) {
      line += ',';
      if (markers::Seen(p)) json::AppendNumber(line, static_cast<double>(v), kDecimals);
    }
  }
  out_.Write(line + "\n");
}

}  // namespace facewire::tools
