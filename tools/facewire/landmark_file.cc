#include "tools/facewire/landmark_file.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "app/error.h"
#include "tools/facewire/json.h"
#include "tools/facewire/json_reader.h"

namespace facewire::tools {
namespace {

// A thousandth of a pixel: far below what the networks resolve.
constexpr int kDecimals = 3;

void AppendPoint(std::string& line, const Point3& p) {
  char separator = '[';
  for (const float v : {p.x, p.y, p.z}) {
    line += separator;
    json::AppendNumber(line, static_cast<double>(v), kDecimals);
    separator = ',';
  }
  line += ']';
}

// What a line holds, before it is known to be complete.
struct Line {
  std::optional<double> frame, t_us, width, height;
  double presence = 1;
  bool has_landmarks = false;  // the key; they may be null
  std::size_t count = 0;
  std::array<Point3, kMaxLandmarks> points{};
};

bool ReadPoint(json::Reader& text, Point3& point) {
  if (!text.Take('[')) return false;
  float* const axes[] = {&point.x, &point.y, &point.z};
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && !text.Take(',')) return false;
    const auto value = text.Number();
    if (!value) return false;
    *axes[i] = static_cast<float>(*value);
  }
  return text.Take(']');
}

// Counts points beyond the capacity without keeping them: the count is for the message.
bool ReadPoints(json::Reader& text, Line& line) {
  line.has_landmarks = true;
  if (text.Null()) return true;
  if (!text.Take('[')) return false;
  if (text.Take(']')) return true;
  do {
    Point3 point;
    if (!ReadPoint(text, point)) return false;
    if (line.count < line.points.size()) line.points[line.count] = point;
    ++line.count;
  } while (text.Take(','));
  return text.Take(']');
}

bool ReadValue(json::Reader& text, std::string_view key, Line& line) {
  const auto number = [&](auto& into) {
    const auto value = text.Number();
    if (value) into = *value;
    return value.has_value();
  };
  if (key == "frame") return number(line.frame);
  if (key == "t_us") return number(line.t_us);
  if (key == "width") return number(line.width);
  if (key == "height") return number(line.height);
  if (key == "presence") return number(line.presence);
  if (key == "landmarks") return ReadPoints(text, line);
  return text.Skip();
}

std::optional<Line> Parse(std::string_view contents) {
  json::Reader text(contents);
  Line line;
  if (!text.Take('{')) return std::nullopt;
  do {
    const auto key = text.String();
    if (!key || !text.Take(':') || !ReadValue(text, *key, line)) return std::nullopt;
  } while (text.Take(','));
  if (!text.Take('}') || !text.AtEnd()) return std::nullopt;
  return line;
}

// Whole, and small enough for every integer type here.
bool Counts(std::optional<double> value, double low, double high) {
  return value && *value >= low && *value <= high && std::floor(*value) == *value;
}

}  // namespace

std::string LandmarkLine(const Sighting& sighting) {
  const auto& face = sighting.face;
  std::string line = "{\"frame\":";
  json::AppendInteger(line, static_cast<std::int64_t>(sighting.frame));
  line += ",\"t_us\":";
  json::AppendInteger(line, sighting.t_us);
  line += face ? ",\"state\":\"tracking\",\"presence\":" : ",\"state\":\"searching\",\"presence\":";
  json::AppendNumber(line, face ? static_cast<double>(face->presence) : 0.0, 4);
  if (!face) return line + ",\"landmarks\":null}\n";
  line += ",\"width\":";
  json::AppendInteger(line, face->width_px);
  line += ",\"height\":";
  json::AppendInteger(line, face->height_px);
  line += ",\"landmarks\":";
  for (std::size_t i = 0; i < face->count; ++i) {
    line += i == 0 ? '[' : ',';
    AppendPoint(line, face->points_px[i]);
  }
  return line + "]}\n";
}

bool IsLandmarkFile(const std::string& path) { return path.ends_with(".jsonl"); }

LandmarkFile::LandmarkFile(const std::string& path) : path_(path), file_(path) {
  if (!file_) throw app::BadInput(path + ": cannot be read; is the path right?");
}

std::optional<Sighting> LandmarkFile::Next() {
  std::string contents;
  do {
    if (!std::getline(file_, contents)) return std::nullopt;
    ++line_;
  } while (json::Reader(contents).AtEnd());
  const auto refuse = [&](const std::string& what) {
    throw app::BadInput(path_ + ":" + std::to_string(line_) + ": " + what);
  };
  const auto line = Parse(contents);
  if (!line || !line->has_landmarks)
    refuse(
        "not a line of `facewire track`, which is "
        "{\"frame\":0,\"t_us\":0,...,\"landmarks\":[[x,y,z],...]}");
  if (!Counts(line->frame, 0, 1e15) || !Counts(line->t_us, 0, 1e15))
    refuse("\"frame\" and \"t_us\" have to be whole numbers from 0 up");
  Sighting seen{static_cast<std::uint64_t>(*line->frame), static_cast<std::int64_t>(*line->t_us),
                std::nullopt};
  if (last_ && seen.frame <= last_->frame)
    refuse("frame " + std::to_string(seen.frame) + " comes after frame " +
           std::to_string(last_->frame) + "; frames have to count up");
  if (last_ && seen.t_us < last_->t_us) refuse("its t_us is before that of the line above");
  last_ = seen;
  if (line->count == 0) return seen;
  if (line->count != kMaxLandmarks && line->count != kMeshLandmarks)
    refuse(std::to_string(line->count) + " landmarks; " + std::to_string(kMeshLandmarks) + " or " +
           std::to_string(kMaxLandmarks) + " would be right");
  if (!Counts(line->width, 1, 1e5) || !Counts(line->height, 1, 1e5))
    refuse("the pose needs the size of the picture in pixels, as \"width\" and \"height\"");
  Landmarks& face = seen.face.emplace();
  face.seq = seen.frame;
  face.captured = Time{Duration{seen.t_us}};
  face.width_px = static_cast<int>(*line->width);
  face.height_px = static_cast<int>(*line->height);
  face.presence = static_cast<float>(line->presence);
  face.count = line->count;
  face.points_px = line->points;
  return seen;
}

}  // namespace facewire::tools
