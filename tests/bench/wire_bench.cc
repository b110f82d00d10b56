#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"

namespace facewire::wire {
namespace {

Rig RigOf(std::int64_t channels) {
  Rig rig;
  for (std::int64_t i = 0; i < channels; ++i) {
    Channel c;
    c.name = *ShortName::From("channel" + std::to_string(i));
    (void)rig.channels.try_push(c);
  }
  return rig;
}

RigPose SomePose(const Rig& rig) {
  RigPose pose = rig.NeutralPose();
  for (std::size_t i = 0; i < pose.count; ++i) pose.values[i] = static_cast<float>(i % 10) / 10;
  return pose;
}

// What the service does for a frame: quantise, CRC, COBS.
void EncodePose(benchmark::State& state) {
  const Rig rig = RigOf(state.range(0));
  const RigPose pose = SomePose(rig);
  Encoder encoder;
  std::array<std::byte, kMaxPoseFrameBytes> buffer;
  std::size_t bytes = 0;
  for (auto _ : state) {
    const auto frame =
        encoder.Encode(MakePose(rig, 1, pose, ServiceState::kTracking, Time{}), buffer);
    bytes = frame->size();
    benchmark::DoNotOptimize(buffer);
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(EncodePose)->Arg(16)->Arg(64)->Arg(static_cast<int>(kMaxChannels));

// What a host does for a frame: COBS, CRC, values.
void DecodePose(benchmark::State& state) {
  const Rig rig = RigOf(state.range(0));
  std::array<std::byte, kMaxPoseFrameBytes> buffer;
  const auto frame =
      Encoder().Encode(MakePose(rig, 1, SomePose(rig), ServiceState::kTracking, Time{}), buffer);
  Decoder decoder;
  for (auto _ : state) {
    std::span<const std::byte> rest = *frame;
    const auto received = decoder.Next(rest);
    benchmark::DoNotOptimize(ValuesOf(std::get<Pose>(received->message), rig));
  }
}
BENCHMARK(DecodePose)->Arg(16)->Arg(64)->Arg(static_cast<int>(kMaxChannels));

}  // namespace
}  // namespace facewire::wire
