#ifndef FACEWIRE_CORE_TRACK_XNN_NETWORK_H_
#define FACEWIRE_CORE_TRACK_XNN_NETWORK_H_

#include <array>
#include <cstddef>
#include <span>

#include "core/base/result.h"
#include "core/track/network_memory.h"
#include "core/track/tflite_model.h"

struct xnn_runtime;

namespace facewire::track {

// One compiled part of a model: everything between some of its tensors and some others. The buffers
// of inputs and outputs are fixed when it is built, so that a run only computes.
class XnnNetwork {
 public:
  static constexpr std::size_t kMaxExternals = 8;

  XnnNetwork() noexcept = default;
  XnnNetwork(const XnnNetwork&) = delete;
  XnnNetwork& operator=(const XnnNetwork&) = delete;

  // `inputs` and `outputs` are tensor indices of the model, together at most kMaxExternals. The
  // memory must outlive the network. kCorrupt (no such network), kFull, kUnsupported.
  Result<> Build(const TfliteModel& model, std::span<const int> inputs,
                 std::span<const int> outputs, NetworkMemory& memory) noexcept;

  // The i-th of the inputs and outputs given to Build: height x width x channels, channels last.
  std::span<float> input(std::size_t i) noexcept { return externals_[i]; }
  std::span<const float> output(std::size_t i) const noexcept { return externals_[inputs_ + i]; }

  // Computes the outputs from the inputs. Allocates nothing. kNotReady before Build.
  Result<> Run() noexcept;

 private:
  xnn_runtime* runtime_ = nullptr;  // in the memory given to Build, so nobody deletes it
  std::size_t inputs_ = 0;
  std::array<std::span<float>, kMaxExternals> externals_{};  // inputs, then outputs
};

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_XNN_NETWORK_H_
