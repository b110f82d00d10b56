#include "core/track/tflite_model.h"

#include <algorithm>
#include <bit>

#include "tflite_generated.h"

namespace facewire::track {
namespace {

// Far above what the networks have, far below what overflows an int.
constexpr std::size_t kMaxElements = std::size_t{1} << 24;
constexpr int kMaxDimension = 1 << 16;
// Numbers are read in place; the format's largest has eight bytes.
constexpr std::size_t kAlignment = 8;

using Indices = flatbuffers::Vector<std::int32_t>;

const tflite::Model& Root(const void* model) noexcept {
  return *static_cast<const tflite::Model*>(model);
}
const tflite::SubGraph& Graph(const void* model) noexcept {
  return *Root(model).subgraphs()->Get(0);
}

// 0 for a type whose size nobody here needs to know.
std::size_t ElementSize(tflite::TensorType type) noexcept {
  switch (type) {
    case tflite::TensorType::kFloat32:
    case tflite::TensorType::kInt32:
      return 4;
    case tflite::TensorType::kFloat16:
      return 2;
  }
  return 0;
}

bool IsGoodShape(const Indices* shape) noexcept {
  if (shape == nullptr) return true;  // a scalar
  if (shape->size() > 4) return false;
  std::size_t elements = 1;
  for (const std::int32_t dimension : *shape) {
    if (dimension < 1 || dimension > kMaxDimension) return false;
    elements *= static_cast<std::size_t>(dimension);
    if (elements > kMaxElements) return false;
  }
  return true;
}

std::size_t CountElements(const Indices* shape) noexcept {
  std::size_t elements = 1;
  if (shape == nullptr) return elements;
  for (const std::int32_t dimension : *shape) elements *= static_cast<std::size_t>(dimension);
  return elements;
}

bool IsGoodTensor(const tflite::Model& model, const tflite::Tensor* tensor) noexcept {
  if (tensor == nullptr || !IsGoodShape(tensor->shape())) return false;
  if (tensor->buffer() >= model.buffers()->size()) return false;
  const tflite::Buffer* buffer = model.buffers()->Get(tensor->buffer());
  if (buffer == nullptr) return false;
  const std::size_t element = ElementSize(tensor->type());
  if (buffer->data() == nullptr || buffer->data()->size() == 0 || element == 0) return true;
  return buffer->data()->size() == CountElements(tensor->shape()) * element;
}

bool AreGoodIndices(const Indices* indices, int lowest, std::size_t tensors) noexcept {
  if (indices == nullptr) return false;
  return std::all_of(indices->begin(), indices->end(), [&](std::int32_t i) {
    return i >= lowest && (i < 0 || static_cast<std::size_t>(i) < tensors);
  });
}

bool IsGoodOperator(const tflite::Model& model, const tflite::Operator* op,
                    std::size_t tensors) noexcept {
  if (op == nullptr || op->code_index() >= model.operator_codes()->size()) return false;
  if (model.operator_codes()->Get(op->code_index()) == nullptr) return false;
  return AreGoodIndices(op->inputs(), -1, tensors) && AreGoodIndices(op->outputs(), 0, tensors) &&
         op->inputs()->size() <= 4 && op->outputs()->size() >= 1;
}

bool IsGoodModel(const tflite::Model& model) noexcept {
  if (model.operator_codes() == nullptr || model.buffers() == nullptr) return false;
  if (model.subgraphs() == nullptr || model.subgraphs()->size() != 1) return false;
  const tflite::SubGraph* graph = model.subgraphs()->Get(0);
  if (graph == nullptr || graph->tensors() == nullptr || graph->operators() == nullptr)
    return false;
  const auto& tensors = *graph->tensors();
  const auto& operators = *graph->operators();
  return std::all_of(tensors.begin(), tensors.end(),
                     [&](const tflite::Tensor* t) { return IsGoodTensor(model, t); }) &&
         std::all_of(operators.begin(), operators.end(), [&](const tflite::Operator* op) {
           return IsGoodOperator(model, op, tensors.size());
         });
}

Operation OperationOf(const tflite::OperatorCode& code) noexcept {
  // The format outgrew the byte; whichever field is larger holds the operation.
  const std::int32_t number = std::max<std::int32_t>(code.short_operation(), code.operation());
  switch (static_cast<tflite::Operation>(number)) {
    case tflite::Operation::kAdd:
      return Operation::kAdd;
    case tflite::Operation::kConv2d:
      return Operation::kConv2d;
    case tflite::Operation::kDepthwiseConv2d:
      return Operation::kDepthwiseConv2d;
    case tflite::Operation::kDequantize:
      return Operation::kDequantize;
    case tflite::Operation::kMaxPool2d:
      return Operation::kMaxPool2d;
    case tflite::Operation::kPad:
      return Operation::kPad;
    case tflite::Operation::kPrelu:
      return Operation::kPrelu;
    case tflite::Operation::kRelu:
      return Operation::kRelu;
    case tflite::Operation::kCustom:
      return Operation::kCustom;
  }
  return Operation::kOther;
}

template <class Options>
void ReadSteps(const Options& options, Operator& to) noexcept {
  to.same_padding = options.padding() == tflite::Padding::kSame;
  to.stride_h = options.stride_h();
  to.stride_w = options.stride_w();
  to.plain = options.activation() == tflite::Activation::kNone;
}

void ReadOptions(const tflite::Operator& op, Operator& to) noexcept {
  if (const auto* conv = op.options_as_Conv2dOptions()) {
    ReadSteps(*conv, to);
    to.plain = to.plain && conv->dilation_h() == 1 && conv->dilation_w() == 1;
  } else if (const auto* depthwise = op.options_as_DepthwiseConv2dOptions()) {
    ReadSteps(*depthwise, to);
    to.plain = to.plain && depthwise->dilation_h() == 1 && depthwise->dilation_w() == 1 &&
               depthwise->depth_multiplier() == 1;
  } else if (const auto* pool = op.options_as_Pool2dOptions()) {
    ReadSteps(*pool, to);
    to.filter_h = pool->filter_h();
    to.filter_w = pool->filter_w();
  } else if (const auto* add = op.options_as_AddOptions()) {
    to.plain = add->activation() == tflite::Activation::kNone;
  }
}

std::span<const std::byte> Bytes(const flatbuffers::Vector<std::uint8_t>* bytes) noexcept {
  if (bytes == nullptr) return {};
  return std::as_bytes(std::span(bytes->data(), bytes->size()));
}

}  // namespace

Result<TfliteModel> TfliteModel::Parse(std::span<const std::byte> file) noexcept {
  if (reinterpret_cast<std::uintptr_t>(file.data()) % kAlignment != 0)
    return Errc::kInvalidArgument;
  // The verifier accepts tables up to this deep and this many: enough for 712 operators.
  flatbuffers::Verifier verifier(reinterpret_cast<const std::uint8_t*>(file.data()), file.size(),
                                 /*max_depth=*/16, /*max_tables=*/10000);
  if (file.size() < 8 || !tflite::VerifyModelBuffer(verifier)) return Errc::kCorrupt;
  const tflite::Model* model = tflite::GetModel(file.data());
  if (model->version() != 3 || !IsGoodModel(*model)) return Errc::kCorrupt;
  return TfliteModel(model);
}

int TfliteModel::tensor_count() const noexcept {
  return static_cast<int>(Graph(model_).tensors()->size());
}

int TfliteModel::operator_count() const noexcept {
  return static_cast<int>(Graph(model_).operators()->size());
}

Tensor TfliteModel::tensor(int index) const noexcept {
  const tflite::Tensor& from = *Graph(model_).tensors()->Get(static_cast<unsigned>(index));
  Tensor tensor;
  tensor.shape = {1, 1, 1, 1};
  if (from.shape() != nullptr) {
    std::copy(from.shape()->begin(), from.shape()->end(),
              tensor.shape.end() - from.shape()->size());
  }
  switch (from.type()) {
    case tflite::TensorType::kFloat32:
      tensor.type = ElementType::kFloat32;
      break;
    case tflite::TensorType::kFloat16:
      tensor.type = ElementType::kFloat16;
      break;
    case tflite::TensorType::kInt32:
      tensor.type = ElementType::kInt32;
      break;
  }
  tensor.data = Bytes(Root(model_).buffers()->Get(from.buffer())->data());
  return tensor;
}

Operator TfliteModel::op(int index) const noexcept {
  const tflite::Operator& from = *Graph(model_).operators()->Get(static_cast<unsigned>(index));
  const tflite::OperatorCode& code = *Root(model_).operator_codes()->Get(from.code_index());
  Operator op;
  op.operation = OperationOf(code);
  for (const std::int32_t input : *from.inputs()) {
    // IsGoodOperator has checked that they fit.
    if (!op.inputs.try_push(input)) break;
  }
  op.output = from.outputs()->Get(0);
  ReadOptions(from, op);
  if (op.operation == Operation::kCustom) {
    if (code.custom_name() != nullptr) op.custom_name = code.custom_name()->string_view();
    op.custom_options = Bytes(from.custom_options());
  }
  return op;
}

int TfliteModel::ProducerOf(int tensor) const noexcept {
  const auto& operators = *Graph(model_).operators();
  for (unsigned i = 0; i < operators.size(); ++i) {
    if (operators.Get(i)->outputs()->Get(0) == tensor) return static_cast<int>(i);
  }
  return -1;
}

float HalfToFloat(std::uint16_t half) noexcept {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000U) << 16;
  const std::uint32_t magnitude = half & 0x7fffU;
  if (magnitude >= 0x7c00U) {  // infinity and NaN
    return std::bit_cast<float>(sign | 0x7f800000U | ((magnitude & 0x3ffU) << 13));
  }
  // The bits in place make a float whose exponent is 112 too low; the multiplication puts that
  // right and makes halves below 2^-14 normal on the way.
  const float value = std::bit_cast<float>(magnitude << 13) * 0x1p112F;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) | sign);
}

}  // namespace facewire::track
