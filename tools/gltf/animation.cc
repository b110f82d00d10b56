#include "tools/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "app/error.h"
#include "tools/gltf/model.h"

namespace facewire::tools {
namespace {

constexpr std::size_t kHeadValues = 6;

// x, y, z, w
using Quaternion = std::array<float, 4>;

// R = Ry(yaw) Rx(pitch) Rz(roll), multiplied out for half the angles.
Quaternion FromAngles(const std::array<float, 3>& pitch_yaw_roll_deg) {
  std::array<double, 3> c{};
  std::array<double, 3> s{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double half = static_cast<double>(pitch_yaw_roll_deg[i]) * std::numbers::pi / 360;
    c[i] = std::cos(half);
    s[i] = std::sin(half);
  }
  const auto [cx, cy, cz] = c;
  const auto [sx, sy, sz] = s;
  return {static_cast<float>(cy * sx * cz + sy * cx * sz),
          static_cast<float>(sy * cx * cz - cy * sx * sz),
          static_cast<float>(cy * cx * sz - sy * sx * cz),
          static_cast<float>(cy * cx * cz + sy * sx * sz)};
}

// The six numbers that move one node, as places in a frame's values; -1: always 0. In the order of
// ChannelKind: x, y, z in cm, then pitch, yaw, roll in degrees.
struct Motion {
  std::array<int, 6> at{-1, -1, -1, -1, -1, -1};
  bool moves() const { return std::any_of(at.begin(), at.begin() + 3, IsUsed); }
  bool turns() const { return std::any_of(at.begin() + 3, at.end(), IsUsed); }

 private:
  static bool IsUsed(int place) { return place >= 0; }
};

Motion HeadMotionPlaces() { return {{3, 4, 5, 0, 1, 2}}; }

Motion BoneMotionPlaces(const Rig& rig, std::size_t bone) {
  Motion motion;
  for (std::size_t i = 0; i < rig.channels.size(); ++i) {
    const Channel& channel = rig.channels[i];
    if (channel.bone != static_cast<std::int16_t>(bone)) continue;
    motion.at[static_cast<std::size_t>(channel.kind) -
              static_cast<std::size_t>(ChannelKind::kPositionX)] =
        static_cast<int>(kHeadValues + i);
  }
  return motion;
}

std::array<float, 3> Read(std::span<const float> values, const int* places) {
  std::array<float, 3> triple{};
  for (std::size_t i = 0; i < 3; ++i)
    if (places[i] >= 0) triple[i] = values[static_cast<std::size_t>(places[i])];
  return triple;
}

// Builds one glTF animation, a sampler and a channel at a time; all share the times.
class Track {
 public:
  Track(std::span<const float> times_s, BufferWriter& buffer)
      : buffer_(buffer), times_(buffer.Add(times_s, TINYGLTF_TYPE_SCALAR, true)) {}

  void Add(int node, const char* path, std::span<const float> values, int type) {
    tinygltf::AnimationSampler sampler;
    sampler.input = times_;
    sampler.output = buffer_.Add(values, type);
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation_.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation_.samplers.push_back(std::move(sampler));
    animation_.channels.push_back(std::move(channel));
  }

  tinygltf::Animation Take() { return std::move(animation_); }

 private:
  BufferWriter& buffer_;
  int times_;
  tinygltf::Animation animation_;
};

}  // namespace

GltfAnimation::GltfAnimation(const Rig& rig) : rig_(rig) {}

void GltfAnimation::Add(std::int64_t t_us, const std::array<float, 6>& head, const RigPose& pose) {
  const auto t_s = static_cast<float>(static_cast<double>(t_us) * 1e-6);
  if (!times_s_.empty() && !(t_s > times_s_.back())) return;
  times_s_.push_back(t_s);
  values_.insert(values_.end(), head.begin(), head.end());
  values_.insert(values_.end(), pose.values.begin(),
                 pose.values.begin() + static_cast<std::ptrdiff_t>(rig_.channels.size()));
}

void GltfAnimation::AddLost(std::int64_t t_us) {
  RigPose held = rig_.NeutralPose();
  std::array<float, kHeadValues> head{};
  if (frames() > 0) {
    const auto last = Values(frames() - 1);
    std::ranges::copy(last.first(kHeadValues), head.begin());
    std::ranges::copy(last.subspan(kHeadValues), held.values.begin());
  }
  Add(t_us, head, held);
}

std::span<const float> GltfAnimation::Values(std::size_t frame) const {
  const std::size_t width = kHeadValues + rig_.channels.size();
  return std::span(values_).subspan(frame * width, width);
}

std::string GltfAnimation::Encode(const std::string& name) const {
  tinygltf::Model model;
  BufferWriter buffer(model);
  const ModelNodes nodes = AddCharacter(rig_, buffer, model);

  if (frames() > 0) {
    Track track(times_s_, buffer);
    const auto animate = [&](int node, const Motion& motion, Point3 rest_cm) {
      std::vector<float> places;
      std::vector<float> turns;
      Quaternion last{0, 0, 0, 1};
      for (std::size_t f = 0; f < frames(); ++f) {
        if (motion.moves()) {
          const auto [x, y, z] = Read(Values(f), motion.at.data());
          for (const float cm : {rest_cm.x + x, rest_cm.y + y, rest_cm.z + z})
            places.push_back(kMetresPerCm * cm);
        }
        if (!motion.turns()) continue;
        Quaternion q = FromAngles(Read(Values(f), motion.at.data() + 3));
        // q and -q turn alike; between two that point apart, an importer that only interpolates
        // numbers would spin the bone the long way round.
        if (q[0] * last[0] + q[1] * last[1] + q[2] * last[2] + q[3] * last[3] < 0)
          for (float& v : q) v = -v;
        turns.insert(turns.end(), q.begin(), q.end());
        last = q;
      }
      if (motion.moves()) track.Add(node, "translation", places, TINYGLTF_TYPE_VEC3);
      if (motion.turns()) track.Add(node, "rotation", turns, TINYGLTF_TYPE_VEC4);
    };
    animate(nodes.head, HeadMotionPlaces(), {});
    for (std::size_t bone = 0; bone < rig_.bones.size(); ++bone)
      animate(nodes.bones[bone], BoneMotionPlaces(rig_, bone), rig_.bones[bone].rest_cm);
    if (nodes.face >= 0) {
      const std::vector<std::size_t> parameters = ParametersOf(rig_);
      std::vector<float> weights;
      for (std::size_t f = 0; f < frames(); ++f)
        for (const std::size_t p : parameters)
          weights.push_back(MorphWeight(rig_.channels[p], Values(f)[kHeadValues + p]));
      track.Add(nodes.face, "weights", weights, TINYGLTF_TYPE_SCALAR);
    }
    model.animations.push_back(track.Take());
    model.animations.back().name = name;
  }

  std::ostringstream out;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, out, false, true))
    throw app::Failure("encoding the glTF failed");
  return std::move(out).str();
}

}  // namespace facewire::tools
