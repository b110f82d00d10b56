#include "core/track/xnn_network.h"

#include <xnnpack.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/track/operator_shape.h"

namespace facewire::track {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kCacheLine = 64;

Result<> FromXnn(xnn_status status) noexcept {
  switch (status) {
    case xnn_status_success:
      return {};
    case xnn_status_out_of_memory:
      return Errc::kFull;
    case xnn_status_unsupported_hardware:
      return Errc::kUnsupported;
    default:
      return Errc::kCorrupt;
  }
}

std::array<std::size_t, 4> Dimensions(const Shape& shape) noexcept {
  return {static_cast<std::size_t>(shape[0]), static_cast<std::size_t>(shape[1]),
          static_cast<std::size_t>(shape[2]), static_cast<std::size_t>(shape[3])};
}

// XNNPACK has no version to ask, but the header that brought what is new here also brought this
// macro.
#ifdef XNN_DEPRECATED
xnn_status DefineAdd(xnn_subgraph_t graph, std::uint32_t a, std::uint32_t b,
                     std::uint32_t out) noexcept {
  return xnn_define_binary(graph, xnn_binary_add, nullptr, a, b, out, 0);
}
xnn_status DefineRelu(xnn_subgraph_t graph, std::uint32_t in, std::uint32_t out) noexcept {
  const xnn_unary_params params = {.clamp = {.min = 0.0F, .max = kInfinity}};
  return xnn_define_unary(graph, xnn_unary_clamp, &params, in, out, 0);
}
xnn_status DefinePrelu(xnn_subgraph_t graph, std::uint32_t in, std::uint32_t slopes,
                       std::uint32_t out) noexcept {
  return xnn_define_binary(graph, xnn_binary_prelu, nullptr, in, slopes, out, 0);
}
// Plans the memory and fixes the buffers; xnn_setup_runtime would not tell when the memory is too
// small.
xnn_status SetUp(xnn_runtime_t runtime, std::span<const xnn_external_value> bindings) noexcept {
  const xnn_status planned = xnn_reshape_runtime(runtime);
  return planned != xnn_status_success
             ? planned
             : xnn_setup_runtime_v2(runtime, bindings.size(), bindings.data());
}
#else
xnn_status DefineAdd(xnn_subgraph_t graph, std::uint32_t a, std::uint32_t b,
                     std::uint32_t out) noexcept {
  return xnn_define_add2(graph, -kInfinity, kInfinity, a, b, out, 0);
}
xnn_status DefineRelu(xnn_subgraph_t graph, std::uint32_t in, std::uint32_t out) noexcept {
  return xnn_define_clamp(graph, 0.0F, kInfinity, in, out, 0);
}
xnn_status DefinePrelu(xnn_subgraph_t graph, std::uint32_t in, std::uint32_t slopes,
                       std::uint32_t out) noexcept {
  return xnn_define_prelu(graph, in, slopes, out, 0);
}
xnn_status SetUp(xnn_runtime_t runtime, std::span<const xnn_external_value> bindings) noexcept {
  return xnn_setup_runtime(runtime, bindings.size(), bindings.data());
}
#endif

// Translates part of a model into an XNNPACK subgraph. All its memory is temporary.
class GraphBuilder {
 public:
  GraphBuilder(const TfliteModel& model, NetworkMemory& memory) noexcept
      : model_(model), memory_(memory) {}

  Result<> Begin() noexcept {
    const auto tensors = static_cast<std::size_t>(model_.tensor_count());
    const auto operators = static_cast<std::size_t>(model_.operator_count());
    auto* values = static_cast<std::uint32_t*>(
        memory_.AllocateTemporary(tensors * sizeof(std::uint32_t), alignof(std::uint32_t)));
    auto* needed = static_cast<bool*>(memory_.AllocateTemporary(tensors, 1));
    auto* constant = static_cast<bool*>(memory_.AllocateTemporary(tensors, 1));
    auto* chosen = static_cast<bool*>(memory_.AllocateTemporary(operators, 1));
    if (values == nullptr || needed == nullptr || constant == nullptr || chosen == nullptr) {
      return Errc::kFull;
    }
    values_ = {values, tensors};
    needed_ = {needed, tensors};
    constant_ = {constant, tensors};
    chosen_ = {chosen, operators};
    std::ranges::fill(values_, XNN_INVALID_VALUE_ID);
    std::ranges::fill(needed_, false);
    std::ranges::fill(constant_, false);
    std::ranges::fill(chosen_, false);
    return FromXnn(xnn_create_subgraph(XnnNetwork::kMaxExternals, 0, &graph_));
  }

  // External values have to be defined before the operators that touch them.
  Result<> AddExternal(int tensor, std::uint32_t id, std::uint32_t flags) noexcept {
    if (tensor < 0 || tensor >= model_.tensor_count()) return Errc::kCorrupt;
    const Tensor t = model_.tensor(tensor);
    if (t.type != ElementType::kFloat32 || !t.data.empty() || IsDefined(tensor))
      return Errc::kCorrupt;
    const auto dimensions = Dimensions(t.shape);
    return FromXnn(xnn_define_tensor_value(graph_, xnn_datatype_fp32, 4, dimensions.data(), nullptr,
                                           id, flags, &values_[tensor]));
  }

  // Marks what the outputs depend on, back to the inputs.
  void Choose(std::span<const int> inputs, std::span<const int> outputs) noexcept {
    for (const int output : outputs) needed_[output] = true;
    for (int i = model_.operator_count() - 1; i >= 0; --i) {
      const Operator op = model_.op(i);
      if (!needed_[op.output] || std::ranges::find(inputs, op.output) != inputs.end()) continue;
      if (op.operation == Operation::kDequantize) continue;  // a constant: see ConstantFloats
      chosen_[i] = true;
      for (const int input : op.inputs) {
        if (input >= 0) needed_[input] = true;
      }
    }
  }

  Result<> AddChosenOperators(std::span<const int> inputs) noexcept {
    // `needed_` now serves to tell which tensors have been computed so far: XNNPACK runs operators
    // in the order of definition and would read garbage otherwise.
    std::ranges::fill(needed_, false);
    for (const int input : inputs) needed_[input] = true;
    for (int i = 0; i < model_.operator_count(); ++i) {
      if (!chosen_[i]) continue;
      const Operator op = model_.op(i);
      if (op.inputs.empty() || op.inputs[0] < 0 || !needed_[op.inputs[0]]) return Errc::kCorrupt;
      if (op.operation == Operation::kAdd &&
          (op.inputs.size() < 2 || op.inputs[1] < 0 || !needed_[op.inputs[1]])) {
        return Errc::kCorrupt;
      }
      if (needed_[op.output] || !IsConsistent(model_, op)) return Errc::kCorrupt;
      if (auto added = Add(op); !added) return added;
      needed_[op.output] = true;
    }
    return {};
  }

  bool IsComputed(int tensor) const noexcept { return needed_[tensor]; }
  xnn_subgraph_t graph() const noexcept { return graph_; }

 private:
  bool IsDefined(int tensor) const noexcept { return values_[tensor] != XNN_INVALID_VALUE_ID; }

  // The value of an operator's output. XNNPACK would write into a constant without a murmur.
  Result<> DefineOutput(int tensor) noexcept {
    if (constant_[tensor]) return Errc::kCorrupt;
    if (IsDefined(tensor)) return {};
    const Tensor t = model_.tensor(tensor);
    if (t.type != ElementType::kFloat32 || !t.data.empty()) return Errc::kCorrupt;
    const auto dimensions = Dimensions(t.shape);
    return FromXnn(xnn_define_tensor_value(graph_, xnn_datatype_fp32, 4, dimensions.data(), nullptr,
                                           XNN_INVALID_VALUE_ID, 0, &values_[tensor]));
  }

  // Filters and biases are packed into the runtime; slopes are read where they are at every run (by
  // older versions of XNNPACK they are packed, too).
  enum class Constant { kFilter, kBias, kSlopes };

  // Floats of a constant: stored as such, or as halves behind a DEQUANTIZE. nullptr with `error`
  // set when it is neither, or memory is used up.
  const float* ConstantFloats(int index, Constant kind, Errc& error) noexcept {
    Tensor t = model_.tensor(index);
    const Shape shape = t.shape;
    if (t.data.empty()) {
      const int producer = model_.ProducerOf(index);
      if (producer >= 0) {
        const Operator op = model_.op(producer);
        if (op.operation == Operation::kDequantize && op.inputs.size() == 1 && op.inputs[0] >= 0) {
          t = model_.tensor(op.inputs[0]);
        }
      }
    }
    const std::size_t count = ElementCount(shape);
    error = Errc::kCorrupt;
    if (t.shape != shape || t.data.empty()) return nullptr;
    if (t.type != ElementType::kFloat32 && t.type != ElementType::kFloat16) return nullptr;
    const std::size_t bytes = count * sizeof(float);
    auto* floats = static_cast<float*>(kind == Constant::kSlopes
                                           ? memory_.AllocatePermanent(bytes, kCacheLine)
                                           : memory_.AllocateTemporary(bytes, kCacheLine));
    error = Errc::kFull;
    if (floats == nullptr) return nullptr;
    if (t.type == ElementType::kFloat32) {
      std::memcpy(floats, t.data.data(), bytes);
      return floats;
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::uint16_t half = 0;
      std::memcpy(&half, t.data.data() + i * sizeof half, sizeof half);
      floats[i] = HalfToFloat(half);
    }
    return floats;
  }

  // To XNNPACK a vector has one dimension.
  Result<> DefineConstant(int tensor, Constant kind) noexcept {
    if (constant_[tensor]) return {};
    if (IsDefined(tensor)) return Errc::kCorrupt;
    constant_[tensor] = true;
    Errc error{};
    const float* floats = ConstantFloats(tensor, kind, error);
    const bool vector = kind != Constant::kFilter;
    if (floats == nullptr) return error;
    const auto dimensions = Dimensions(model_.tensor(tensor).shape);
    return FromXnn(xnn_define_tensor_value(graph_, xnn_datatype_fp32, vector ? 1 : 4,
                                           vector ? &dimensions[3] : dimensions.data(), floats,
                                           XNN_INVALID_VALUE_ID, 0, &values_[tensor]));
  }

  Result<> DefineConstants(const Operator& op) noexcept {
    switch (op.operation) {
      case Operation::kConv2d:
      case Operation::kDepthwiseConv2d:
        if (auto defined = DefineConstant(op.inputs[1], Constant::kFilter); !defined)
          return defined;
        return DefineConstant(op.inputs[2], Constant::kBias);
      case Operation::kPrelu:
        return DefineConstant(op.inputs[1], Constant::kSlopes);
      default:
        return {};
    }
  }

  Result<> Add(const Operator& op) noexcept {
    if (auto defined = DefineOutput(op.output); !defined) return defined;
    if (auto defined = DefineConstants(op); !defined) return defined;
    return FromXnn(AddNode(op, values_[op.inputs[0]], values_[op.output]));
  }

  xnn_status AddNode(const Operator& op, std::uint32_t in, std::uint32_t out) noexcept {
    const std::uint32_t flags = op.same_padding ? XNN_FLAG_TENSORFLOW_SAME_PADDING : 0;
    const auto stride_h = static_cast<std::uint32_t>(op.stride_h);
    const auto stride_w = static_cast<std::uint32_t>(op.stride_w);
    switch (op.operation) {
      case Operation::kAdd:
        return DefineAdd(graph_, in, values_[op.inputs[1]], out);
      case Operation::kRelu:
        return DefineRelu(graph_, in, out);
      case Operation::kPrelu:
        return DefinePrelu(graph_, in, values_[op.inputs[1]], out);
      case Operation::kMaxPool2d:
        return xnn_define_max_pooling_2d(graph_, 0, 0, 0, 0,
                                         static_cast<std::uint32_t>(op.filter_h),
                                         static_cast<std::uint32_t>(op.filter_w), stride_h,
                                         stride_w, 1, 1, -kInfinity, kInfinity, in, out, flags);
      case Operation::kConv2d: {
        const auto filter = Dimensions(model_.tensor(op.inputs[1]).shape);
        return xnn_define_convolution_2d(graph_, 0, 0, 0, 0, static_cast<std::uint32_t>(filter[1]),
                                         static_cast<std::uint32_t>(filter[2]), stride_h, stride_w,
                                         1, 1, 1, filter[3], filter[0], -kInfinity, kInfinity, in,
                                         values_[op.inputs[1]], values_[op.inputs[2]], out, flags);
      }
      case Operation::kDepthwiseConv2d: {
        const auto filter = Dimensions(model_.tensor(op.inputs[1]).shape);
        return xnn_define_depthwise_convolution_2d(
            graph_, 0, 0, 0, 0, static_cast<std::uint32_t>(filter[1]),
            static_cast<std::uint32_t>(filter[2]), stride_h, stride_w, 1, 1, 1, filter[3],
            -kInfinity, kInfinity, in, values_[op.inputs[1]], values_[op.inputs[2]], out, flags);
      }
      case Operation::kPad: {
        const Padding padding = ReadPadding(model_, op);
        const auto before = Dimensions(padding.before);
        const auto behind = Dimensions(padding.behind);
        return xnn_define_static_constant_pad(graph_, before.data(), behind.data(), 0.0F, in, out,
                                              0);
      }
      default:
        return xnn_status_unsupported_parameter;  // IsConsistent does not let it come to this
    }
  }

  const TfliteModel& model_;
  NetworkMemory& memory_;
  xnn_subgraph_t graph_ = nullptr;
  std::span<std::uint32_t> values_;  // of each tensor of the model: XNNPACK's value
  std::span<bool> needed_;           // of each tensor
  std::span<bool> constant_;         // of each tensor: defined as a constant
  std::span<bool> chosen_;           // of each operator
};

}  // namespace

Result<> XnnNetwork::Build(const TfliteModel& model, std::span<const int> inputs,
                           std::span<const int> outputs, NetworkMemory& memory) noexcept {
  const std::size_t externals = inputs.size() + outputs.size();
  if (externals > kMaxExternals) return Errc::kInvalidArgument;
  memory.ReleaseTemporary();
  GraphBuilder builder(model, memory);
  std::array<xnn_external_value, kMaxExternals> bindings{};
  {
    const NetworkMemory::Scope scope(memory, NetworkMemory::Scope::Kind::kTemporary);
    if (auto begun = builder.Begin(); !begun) return begun;
    for (std::size_t i = 0; i < externals; ++i) {
      const bool is_input = i < inputs.size();
      const int tensor = is_input ? inputs[i] : outputs[i - inputs.size()];
      const auto id = static_cast<std::uint32_t>(i);
      auto added = builder.AddExternal(
          tensor, id, is_input ? XNN_VALUE_FLAG_EXTERNAL_INPUT : XNN_VALUE_FLAG_EXTERNAL_OUTPUT);
      if (!added) return added;
      const std::size_t count = ElementCount(model.tensor(tensor).shape);
      auto* floats =
          static_cast<float*>(memory.AllocatePermanent(count * sizeof(float), kCacheLine));
      if (floats == nullptr) return Errc::kFull;
      externals_[i] = {floats, count};
      std::ranges::fill(externals_[i], 0.0F);
      bindings[i] = {.id = id, .data = floats};
    }
    builder.Choose(inputs, outputs);
    if (auto added = builder.AddChosenOperators(inputs); !added) return added;
  }
  for (const int output : outputs) {
    if (!builder.IsComputed(output)) return Errc::kCorrupt;
  }
  const NetworkMemory::Scope scope(memory, NetworkMemory::Scope::Kind::kPermanent);
  xnn_runtime_t runtime = nullptr;
  auto created = FromXnn(xnn_create_runtime_v2(builder.graph(), nullptr, 0, &runtime));
  if (!created) return created;
  auto bound = FromXnn(SetUp(runtime, std::span(bindings).first(externals)));
  if (!bound) return bound;
  memory.ReleaseTemporary();
  inputs_ = inputs.size();
  runtime_ = runtime;
  return {};
}

Result<> XnnNetwork::Run() noexcept {
  if (runtime_ == nullptr) return Errc::kNotReady;
  return FromXnn(xnn_invoke_runtime(runtime_));
}

}  // namespace facewire::track
