#include "tools/facewire/pose_writer.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "app/error.h"
#include "tools/facewire/json.h"
#include "tools/facewire/output_file.h"
#include "tools/gltf/animation.h"

namespace facewire::tools {
namespace {

constexpr int kDecimals = 5;
constexpr std::array<std::string_view, 6> kHeadNames{"pitch", "yaw", "roll", "x", "y", "z"};

void AppendTriple(std::string& line, const std::array<float, 3>& values) {
  char separator = '[';
  for (const float v : values) {
    line += separator;
    json::AppendNumber(line, static_cast<double>(v), kDecimals);
    separator = ',';
  }
  line += ']';
}

void AppendKey(std::string& line, std::string_view name, bool first) {
  if (!first) line += ',';
  json::AppendString(line, name);
  line += ':';
}

class CsvWriter final : public PoseWriter {
 public:
  CsvWriter(const std::string& path, const Rig& rig)
      : out_(path), empty_(kHeadNames.size() + rig.channels.size(), ',') {
    std::string header = "frame,t_us,state";
    for (const std::string_view name : kHeadNames) header.append(",head.").append(name);
    for (const Channel& channel : rig.channels) header.append(",").append(channel.name.view());
    out_.Write(header + "\n");
  }

  void Write(std::uint64_t frame, std::int64_t t_us, const HeadMotion& head,
             const RigPose& pose) override {
    std::string line = std::to_string(frame) + "," + std::to_string(t_us) + ",tracking";
    const auto append = [&](float v) {
      line += ',';
      json::AppendNumber(line, static_cast<double>(v), kDecimals);
    };
    for (const float v : head) append(v);
    for (std::size_t i = 0; i < pose.count; ++i) append(pose.values[i]);
    out_.Write(line + "\n");
  }

  void WriteLost(std::uint64_t frame, std::int64_t t_us) override {
    out_.Write(std::to_string(frame) + "," + std::to_string(t_us) + ",searching" + empty_ + "\n");
  }

  void Commit() override { out_.Commit(); }

 private:
  OutputFile out_;
  std::string empty_;  // the values of a frame that has none
};

class JsonWriter final : public PoseWriter {
 public:
  JsonWriter(const std::string& path, const Rig& rig) : out_(path), rig_(rig) {}

  void Write(std::uint64_t frame, std::int64_t t_us, const HeadMotion& head,
             const RigPose& pose) override {
    std::string line = "{\"frame\":" + std::to_string(frame) + ",\"t_us\":" + std::to_string(t_us) +
                       ",\"state\":\"tracking\",\"head\":{";
    for (std::size_t i = 0; i < head.size(); ++i) {
      AppendKey(line, kHeadNames[i], i == 0);
      json::AppendNumber(line, static_cast<double>(head[i]), kDecimals);
    }
    line += "},\"bones\":{";
    AppendBones(line, pose);
    line += "},\"params\":{";
    AppendParameters(line, pose);
    out_.Write(line + "}}\n");
  }

  void WriteLost(std::uint64_t frame, std::int64_t t_us) override {
    out_.Write("{\"frame\":" + std::to_string(frame) + ",\"t_us\":" + std::to_string(t_us) +
               ",\"state\":\"searching\",\"head\":null,\"bones\":null,\"params\":null}\n");
  }

  void Commit() override { out_.Commit(); }

 private:
  void AppendBones(std::string& line, const RigPose& pose) const {
    for (std::size_t bone = 0; bone < rig_.bones.size(); ++bone) {
      std::array<float, 3> position{};
      std::array<float, 3> rotation{};
      for (std::size_t i = 0; i < pose.count; ++i) {
        const Channel& channel = rig_.channels[i];
        if (channel.bone != static_cast<std::int16_t>(bone)) continue;
        const auto axis_of = [&](ChannelKind first) {
          return static_cast<std::size_t>(channel.kind) - static_cast<std::size_t>(first);
        };
        if (IsPosition(channel.kind)) position[axis_of(ChannelKind::kPositionX)] = pose.values[i];
        if (IsRotation(channel.kind)) rotation[axis_of(ChannelKind::kPitch)] = pose.values[i];
      }
      AppendKey(line, rig_.bones[bone].name.view(), bone == 0);
      line += "{\"pos\":";
      AppendTriple(line, position);
      line += ",\"rot\":";
      AppendTriple(line, rotation);
      line += '}';
    }
  }

  void AppendParameters(std::string& line, const RigPose& pose) const {
    bool first = true;
    for (std::size_t i = 0; i < pose.count; ++i) {
      if (rig_.channels[i].kind != ChannelKind::kParameter) continue;
      AppendKey(line, rig_.channels[i].name.view(), first);
      json::AppendNumber(line, static_cast<double>(pose.values[i]), kDecimals);
      first = false;
    }
  }

  OutputFile out_;
  const Rig& rig_;
};

// A glTF file begins with what it holds: it can only be written at the end.
class GltfWriter final : public PoseWriter {
 public:
  GltfWriter(const std::string& path, const Rig& rig)
      : out_(path), name_(std::filesystem::path(path).stem().string()), animation_(rig) {}

  void Write(std::uint64_t /*frame*/, std::int64_t t_us, const HeadMotion& head,
             const RigPose& pose) override {
    animation_.Add(t_us, head, pose);
  }

  void WriteLost(std::uint64_t /*frame*/, std::int64_t t_us) override { animation_.AddLost(t_us); }

  void Commit() override {
    out_.Write(animation_.Encode(name_));
    out_.Commit();
  }

 private:
  OutputFile out_;
  std::string name_;  // of the take: programs list animations by name
  GltfAnimation animation_;
};

}  // namespace

std::unique_ptr<PoseWriter> OpenPoseWriter(const std::string& path, const Rig& rig) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".csv") return std::make_unique<CsvWriter>(path, rig);
  if (ending == ".glb") return std::make_unique<GltfWriter>(path, rig);
  if (ending == ".gltf") {
    throw app::BadInput("cannot write " + path +
                        ": glTF comes as one binary file, its name ends in .glb");
  }
  return std::make_unique<JsonWriter>(path, rig);
}

}  // namespace facewire::tools
