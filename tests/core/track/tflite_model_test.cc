#include "core/track/tflite_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/track/operator_shape.h"
#include "tests/support/footage.h"

namespace facewire::track {
namespace {

const std::vector<std::byte>& File() {
  static const auto bytes = test::ReadNetwork("face_detection_short_range.tflite");
  return bytes;
}

TEST(TfliteModelTest, ReadsTensorsAndOperators) {
  const auto model = TfliteModel::Parse(File());
  ASSERT_TRUE(model);
  EXPECT_EQ(model->tensor_count(), 250);
  EXPECT_EQ(model->operator_count(), 164);
  EXPECT_EQ(model->tensor(0).shape, (Shape{1, 128, 128, 3}));
  EXPECT_EQ(model->tensor(0).type, ElementType::kFloat32);
  EXPECT_TRUE(model->tensor(0).data.empty());

  const int first = model->ProducerOf(3);
  ASSERT_GE(first, 0);
  const Operator conv = model->op(first);
  EXPECT_EQ(conv.operation, Operation::kConv2d);
  ASSERT_EQ(conv.inputs.size(), 3U);
  EXPECT_EQ(conv.inputs[0], 0);
  EXPECT_EQ(conv.stride_h, 2);
  EXPECT_TRUE(conv.same_padding);
  EXPECT_TRUE(IsConsistent(*model, conv));
  EXPECT_EQ(model->tensor(conv.inputs[1]).shape, (Shape{24, 5, 5, 3}));
  EXPECT_EQ(model->ProducerOf(0), -1);
}

TEST(TfliteModelTest, ReadsCustomOperators) {
  const auto bytes = test::ReadNetwork("face_landmark_with_attention.tflite");
  const auto model = TfliteModel::Parse(bytes);
  ASSERT_TRUE(model);
  const Operator op = model->op(model->ProducerOf(196));
  EXPECT_EQ(op.operation, Operation::kCustom);
  EXPECT_EQ(op.custom_name, "Landmarks2TransformMatrix");
  EXPECT_FALSE(op.custom_options.empty());
  EXPECT_FALSE(IsConsistent(*model, op));  // not for XNNPACK
}

TEST(TfliteModelTest, ReadsPaddings) {
  const auto model = TfliteModel::Parse(File());
  ASSERT_TRUE(model);
  const Operator pad = model->op(model->ProducerOf(20));
  ASSERT_EQ(pad.operation, Operation::kPad);
  const Padding padding = ReadPadding(*model, pad);
  EXPECT_EQ(padding.before, (std::array<int, 4>{}));
  EXPECT_EQ(padding.behind, (std::array<int, 4>{0, 0, 0, 4}));
}

TEST(TfliteModelTest, AnythingElseIsCorrupt) {
  EXPECT_EQ(TfliteModel::Parse({}).error(), Errc::kCorrupt);
  const std::vector<std::byte> zeros(4096);
  EXPECT_EQ(TfliteModel::Parse(zeros).error(), Errc::kCorrupt);
  const std::vector<std::byte> ones(4096, std::byte{0xff});
  EXPECT_EQ(TfliteModel::Parse(ones).error(), Errc::kCorrupt);
}

TEST(TfliteModelTest, ATruncatedFileIsCorrupt) {
  for (const std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{8}, std::size_t{100},
                                 File().size() / 2, File().size() - 1}) {
    // A copy of its own, so that the address sanitizer sees a read beyond it.
    const std::vector<std::byte> cut(File().begin(), File().begin() + static_cast<long>(size));
    EXPECT_EQ(TfliteModel::Parse(cut).error(), Errc::kCorrupt) << size;
  }
}

TEST(TfliteModelTest, ABufferThatIsNotAlignedIsRefused) {
  std::vector<std::byte> shifted(File().size() + 1);
  std::copy(File().begin(), File().end(), shifted.begin() + 1);
  EXPECT_EQ(TfliteModel::Parse(std::span(shifted).subspan(1)).error(), Errc::kInvalidArgument);
}

TEST(HalfToFloatTest, IsExactForEveryKindOfNumber) {
  EXPECT_EQ(HalfToFloat(0x0000), 0.0F);
  EXPECT_TRUE(std::signbit(HalfToFloat(0x8000)));
  EXPECT_EQ(HalfToFloat(0x3c00), 1.0F);
  EXPECT_EQ(HalfToFloat(0xc000), -2.0F);
  EXPECT_EQ(HalfToFloat(0x3555), 0.333251953125F);
  EXPECT_EQ(HalfToFloat(0x7bff), 65504.0F);
  EXPECT_EQ(HalfToFloat(0x0400), 0x1p-14F);
  EXPECT_EQ(HalfToFloat(0x0001), 0x1p-24F);  // the smallest
  EXPECT_EQ(HalfToFloat(0x83ff), -0x1.ff8p-15F);
  EXPECT_TRUE(std::isinf(HalfToFloat(0x7c00)));
  EXPECT_LT(HalfToFloat(0xfc00), 0);
  EXPECT_TRUE(std::isnan(HalfToFloat(0x7e00)));
}

}  // namespace
}  // namespace facewire::track
