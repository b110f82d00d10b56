#ifndef FACEWIRE_CORE_TRACK_TFLITE_MODEL_H_
#define FACEWIRE_CORE_TRACK_TFLITE_MODEL_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/inline_vector.h"
#include "core/base/result.h"

namespace facewire::track {

enum class Operation : std::uint8_t {
  kAdd,
  kConv2d,
  kDepthwiseConv2d,
  kDequantize,
  kMaxPool2d,
  kPad,
  kPrelu,
  kRelu,
  kCustom,
  kOther,  // an operation that no network here is asked to run
};

enum class ElementType : std::uint8_t { kFloat32, kFloat16, kInt32, kOther };

// Four dimensions (batch, height, width, channels for a picture; smaller ranks are padded with 1 in
// front, which changes neither size nor order).
using Shape = std::array<int, 4>;
constexpr std::size_t ElementCount(const Shape& s) noexcept {
  return static_cast<std::size_t>(s[0]) * s[1] * s[2] * s[3];
}

struct Tensor {
  Shape shape{};
  ElementType type = ElementType::kOther;
  std::span<const std::byte> data;  // constant contents, or empty: computed by an operator
};

// One operator with its options; a field that the operation does not have keeps its default.
struct Operator {
  Operation operation = Operation::kOther;
  InlineVector<int, 4> inputs;  // tensor indices; -1 is an optional input that is not there
  int output = -1;              // tensor index (of the first output)
  bool same_padding = false;    // TensorFlow's SAME; otherwise VALID
  bool plain = true;            // no fused activation, no dilation, depth multiplier 1
  int stride_h = 1, stride_w = 1;
  int filter_h = 1, filter_w = 1;             // of a pooling
  std::string_view custom_name;               // of a custom operation
  std::span<const std::byte> custom_options;  // of a custom operation: a flexbuffer
};

// A view of the bytes of a .tflite file that has been checked as a whole: afterwards every index is
// in range and constant data has the size of its tensor. Allocates nothing; the bytes must stay.
class TfliteModel {
 public:
  // kCorrupt when the bytes are not such a file; kInvalidArgument when they do not start at a
  // multiple of eight.
  static Result<TfliteModel> Parse(std::span<const std::byte> file) noexcept;

  int tensor_count() const noexcept;
  int operator_count() const noexcept;
  Tensor tensor(int index) const noexcept;  // index in 0..tensor_count()-1
  Operator op(int index) const noexcept;    // index in 0..operator_count()-1
  // The operator that computes a tensor, or -1.
  int ProducerOf(int tensor) const noexcept;

 private:
  explicit TfliteModel(const void* model) noexcept : model_(model) {}
  const void* model_;  // the verified root table
};

// IEEE 754 half precision to single: exact.
float HalfToFloat(std::uint16_t half) noexcept;

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_TFLITE_MODEL_H_
