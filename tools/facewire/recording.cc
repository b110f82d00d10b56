#include "tools/facewire/recording.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>

#include "app/error.h"
#include "tools/markers/text.h"
#include "tools/sheet/character.h"

namespace facewire::tools {
namespace {

using markers::Fields;
using markers::NumberOrGap;

constexpr std::size_t kFrame = 0;
constexpr std::size_t kTime = 1;
constexpr std::size_t kAge = 2;
constexpr std::size_t kState = 3;
constexpr std::size_t kFirstChannel = 4;

[[noreturn]] void Refuse(const std::string& path, std::size_t line, const std::string& what) {
  throw app::BadInput(path + ":" + std::to_string(line) + ": " + what);
}

// Which column holds each channel of the rig.
std::vector<std::size_t> ColumnsOf(const std::vector<std::string_view>& header, const Rig& rig,
                                   const std::string& path) {
  if (header.size() < kFirstChannel || header[kFrame] != "frame" || header[kTime] != "t_us" ||
      header[kAge] != "age_us" || header[kState] != "state") {
    Refuse(
        path, 1,
        "not a recording: it begins frame,t_us,age_us,state when `facewire monitor --csv` made it");
  }
  std::vector<std::size_t> columns;
  for (const Channel& channel : rig.channels) {
    const auto found = std::ranges::find(header, channel.name.view());
    if (found == header.end()) {
      Refuse(path, 1,
             "the rig's channel " + std::string(channel.name.view()) +
                 " is not in it; is it another rig's?");
    }
    columns.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return columns;
}

double Quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at =
      static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size()))) - 1;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
  return values[at];
}

// Counts the times that a value passes `on` after having been below `off`.
class Counter {
 public:
  Counter(double on, double off) : on_(on), off_(off) {}
  void Add(double value) {
    if (!inside_ && value > on_) {
      ++count_;
      inside_ = true;
    } else if (value < off_) {
      inside_ = false;
    }
  }
  std::size_t count() const { return count_; }

 private:
  double on_, off_;
  bool inside_ = false;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<RecordedPose> ReadEveryPose(const std::string& path, const Rig& rig) {
  std::ifstream file(path);
  if (!file) throw app::BadInput("cannot read the recording " + path);
  const std::string contents((std::istreambuf_iterator<char>(file)),
                             std::istreambuf_iterator<char>());
  const auto lines = markers::Lines(contents);
  if (lines.empty()) throw app::BadInput(path + ": it is empty");
  const auto header = Fields(lines[0], ',');
  const std::vector<std::size_t> columns = ColumnsOf(header, rig, path);

  std::vector<RecordedPose> recording;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = Fields(lines[i], ',');
    if (fields.size() != header.size()) {
      Refuse(path, i + 1,
             std::to_string(fields.size()) + " fields; the header has " +
                 std::to_string(header.size()));
    }
    const auto number = [&](std::size_t column) {
      const auto value = NumberOrGap(fields[column]);
      if (!value || std::isnan(*value))
        Refuse(path, i + 1, "\"" + std::string(fields[column]) + "\" is not a number");
      return *value;
    };
    RecordedPose recorded;
    recorded.pose.seq = static_cast<std::uint64_t>(number(kFrame));
    recorded.pose.captured = Time{Duration{static_cast<std::int64_t>(number(kTime))}};
    recorded.age_us = static_cast<std::uint32_t>(number(kAge));
    recorded.tracking = fields[kState] == "tracking";
    recorded.holding = fields[kState] == "holding";
    recorded.pose.count = columns.size();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      recorded.pose.values[c] = static_cast<float>(number(columns[c]));
    }
    recording.push_back(recorded);
  }
  if (recording.empty()) throw app::BadInput(path + ": it has no poses");
  return recording;
}

std::vector<RecordedPose> ReadRecording(const std::string& path, const Rig& rig) {
  std::vector<RecordedPose> recording = ReadEveryPose(path, rig);
  const auto same = [](const RecordedPose& a, const RecordedPose& b) {
    return a.pose.seq == b.pose.seq;
  };
  recording.erase(std::unique(recording.begin(), recording.end(), same), recording.end());
  return recording;
}

RecordingFigures FiguresOf(const std::vector<RecordedPose>& recording, const Rig& rig) {
  RecordingFigures figures;
  if (recording.empty()) return figures;
  figures.frames = recording.size();
  const auto span = std::chrono::duration<double>(recording.back().pose.captured -
                                                  recording.front().pose.captured);
  if (span.count() > 0) figures.fps = static_cast<double>(recording.size() - 1) / span.count();

  std::vector<double> ages_ms;
  Counter blinks(0.5, 0.3);
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const RecordedPose& recorded = recording[i];
    ages_ms.push_back(recorded.age_us / 1000.0);
    const CharacterPose character = CharacterPoseOf(rig, recorded.pose);
    blinks.Add(std::min(character.lid_left, character.lid_right));
    if (i == 0) continue;
    const RecordedPose& before = recording[i - 1];
    if (recorded.pose.seq > before.pose.seq)
      figures.missed += recorded.pose.seq - before.pose.seq - 1;
    if (before.tracking && recorded.holding) ++figures.losses;
  }
  figures.blinks = blinks.count();
  figures.latency_p50_ms = Quantile(ages_ms, 0.5);
  figures.latency_p99_ms = Quantile(ages_ms, 0.99);
  return figures;
}

}  // namespace facewire::tools
