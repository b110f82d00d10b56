#include "tools/facewire/monitor_recorder.h"

#include "app/error.h"
#include "core/wire/pose.h"
#include "tools/facewire/json.h"

namespace facewire::tools {
namespace {

// About ten minutes at 60 frames a second: whoever waits longer for a description will not get one.
constexpr std::size_t kMaxWaiting = 36'000;
constexpr int kDecimals = 6;

void AppendCsvName(std::string& out, std::string_view name) {
  if (name.find_first_of(",\"") == std::string_view::npos) {
    out += name;
    return;
  }
  out += '"';
  for (const char c : name) out.append(c == '"' ? 2 : 1, c);
  out += '"';
}

}  // namespace

void MonitorRecorder::Add(const wire::Pose& pose, const wire::RigCollector& rig) {
  WriteWaiting(rig);
  if (has_rig_) {
    WritePose(pose);
  } else if (waiting_.size() < kMaxWaiting) {
    waiting_.push_back(pose);
  }
}

void MonitorRecorder::Finish(const wire::RigCollector& rig) {
  WriteWaiting(rig);
  if (!has_rig_) {
    throw app::Failure(path_ + " was not written: no complete rig description arrived");
  }
  file_.Commit();
}

void MonitorRecorder::WriteWaiting(const wire::RigCollector& rig) {
  if (has_rig_ || !rig.Complete()) return;
  has_rig_ = true;
  rig_id_ = rig.rig_id();
  rig_ = rig.rig();
  if (form_ == Form::kCsv) WriteHeader();
  for (const wire::Pose& pose : waiting_) WritePose(pose);
  waiting_.clear();
}

void MonitorRecorder::WriteHeader() {
  std::string line = "frame,t_us,age_us,state";
  for (const Channel& c : rig_.channels) {
    line += ',';
    AppendCsvName(line, c.name.view());
  }
  file_.Write(line + "\n");
}

void MonitorRecorder::WritePose(const wire::Pose& pose) {
  if (pose.rig_id != rig_id_) {
    ++of_other_rigs_;
    return;
  }
  const RigPose values = wire::ValuesOf(pose, rig_);
  const auto t_us = pose.captured.time_since_epoch().count();
  std::string line;
  if (form_ == Form::kCsv) {
    line = std::to_string(pose.frame_seq) + "," + std::to_string(t_us) + "," +
           std::to_string(pose.age_us) + "," + Name(pose.state);
    for (std::size_t i = 0; i < values.count; ++i) {
      line += ',';
      json::AppendNumber(line, values.values[i], kDecimals);
    }
  } else {
    line = "{\"frame\":" + std::to_string(pose.frame_seq) + ",\"t_us\":" + std::to_string(t_us) +
           ",\"age_us\":" + std::to_string(pose.age_us) + ",\"state\":\"" + Name(pose.state) +
           "\",\"values\":{";
    for (std::size_t i = 0; i < values.count; ++i) {
      if (i > 0) line += ',';
      json::AppendString(line, rig_.channels[i].name.view());
      line += ':';
      json::AppendNumber(line, values.values[i], kDecimals);
    }
    line += "}}";
  }
  file_.Write(line + "\n");
  ++recorded_;
}

}  // namespace facewire::tools
