#include "core/track/operator_shape.h"

#include <cstdint>
#include <cstring>

namespace facewire::track {
namespace {

constexpr int kMaxStride = 16;
constexpr int kMaxFilter = 16;

// Length of an output dimension, as TensorFlow counts it; 0 when nothing fits.
int Steps(int length, int filter, int stride, bool same_padding) noexcept {
  if (same_padding) return (length + stride - 1) / stride;
  return length < filter ? 0 : (length - filter) / stride + 1;
}

bool HasGoodSteps(const Operator& op) noexcept {
  return op.stride_h >= 1 && op.stride_h <= kMaxStride && op.stride_w >= 1 &&
         op.stride_w <= kMaxStride;
}

bool SlidesTo(const Operator& op, const Shape& in, int filter_h, int filter_w,
              const Shape& out) noexcept {
  if (!HasGoodSteps(op) || filter_h < 1 || filter_h > kMaxFilter || filter_w < 1 ||
      filter_w > kMaxFilter) {
    return false;
  }
  return in[0] == 1 && out[0] == 1 &&
         out[1] == Steps(in[1], filter_h, op.stride_h, op.same_padding) &&
         out[2] == Steps(in[2], filter_w, op.stride_w, op.same_padding);
}

bool IsVector(const Shape& shape, int length) noexcept { return shape == Shape{1, 1, 1, length}; }

}  // namespace

Padding ReadPadding(const TfliteModel& model, const Operator& op) noexcept {
  Padding padding;
  const Tensor table = model.tensor(op.inputs[1]);
  if (table.type != ElementType::kInt32 || table.data.size() != 8 * sizeof(std::int32_t))
    return padding;
  std::array<std::int32_t, 8> numbers{};
  std::memcpy(numbers.data(), table.data.data(), table.data.size());
  for (std::size_t i = 0; i < 4; ++i) {
    padding.before[i] = numbers[2 * i];
    padding.behind[i] = numbers[2 * i + 1];
  }
  return padding;
}

bool IsConsistent(const TfliteModel& model, const Operator& op) noexcept {
  std::array<Shape, 4> in{};
  for (std::size_t i = 0; i < op.inputs.size(); ++i) {
    if (op.inputs[i] < 0) return false;
    in[i] = model.tensor(op.inputs[i]).shape;
  }
  const Shape out = model.tensor(op.output).shape;
  const std::size_t count = op.inputs.size();
  if (!op.plain) return false;
  switch (op.operation) {
    case Operation::kAdd:
      return count == 2 && in[0] == in[1] && in[0] == out;
    case Operation::kRelu:
      return count == 1 && in[0] == out;
    case Operation::kPrelu:
      return count == 2 && in[0] == out && IsVector(in[1], out[3]);
    case Operation::kConv2d:
      return count == 3 && in[1][0] == out[3] && in[1][3] == in[0][3] && IsVector(in[2], out[3]) &&
             SlidesTo(op, in[0], in[1][1], in[1][2], out);
    case Operation::kDepthwiseConv2d:
      return count == 3 && in[0][3] == out[3] && in[1][0] == 1 && in[1][3] == out[3] &&
             IsVector(in[2], out[3]) && SlidesTo(op, in[0], in[1][1], in[1][2], out);
    case Operation::kMaxPool2d:
      // XNNPACK has no pooling over a single pixel.
      return count == 1 && in[0][3] == out[3] && op.filter_h * op.filter_w > 1 &&
             SlidesTo(op, in[0], op.filter_h, op.filter_w, out);
    case Operation::kPad: {
      if (count != 2) return false;
      const Padding padding = ReadPadding(model, op);
      for (std::size_t i = 0; i < 4; ++i) {
        if (padding.before[i] < 0 || padding.behind[i] < 0) return false;
        if (padding.before[i] > out[i] || padding.behind[i] > out[i]) return false;
        if (in[0][i] + padding.before[i] + padding.behind[i] != out[i]) return false;
      }
      return true;
    }
    case Operation::kDequantize:
    case Operation::kCustom:
    case Operation::kOther:
      return false;
  }
  return false;
}

}  // namespace facewire::track
