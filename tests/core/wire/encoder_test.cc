#include "core/wire/encoder.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "core/wire/decoder.h"
#include "tests/core/wire/raw_frame.h"

namespace facewire::wire {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Bytes EncodeToBytes(Encoder& encoder, const Message& message) {
  std::array<std::byte, kMaxFrameBytes> buffer;
  const auto frame = encoder.Encode(message, buffer);
  if (!frame) return {};
  return {frame->begin(), frame->end()};
}

std::vector<Message> OneOfEach() {
  Pose pose{.rig_id = 5, .frame_seq = 6, .captured = Time(Duration(7))};
  (void)pose.values.try_resize(3);
  return {RigHeader{},
          BoneDescription{},
          ChannelDescription{},
          pose,
          Status{},
          Acknowledgement{},
          Acknowledgement{.result = CommandResult::kHeadTurned},
          Command{},
          Command{.code = CommandCode::kBlendProfile}};
}

// The bytes in core/wire/README.md, "Examples".
TEST(Encoder, TheExampleOfTheSpecificationIsWhatItWrites) {
  Encoder encoder;
  const Bytes example = MakeBytes(
      {0x00, 0x03, 0x01, 0x80, 0x01, 0x02, 0x01, 0x06, 0x01, 0xB3, 0x9A, 0x6E, 0x53, 0x00});
  EXPECT_EQ(EncodeToBytes(encoder, Command{.id = 1, .code = CommandCode::kPing}), example);
}

// Hosts of before the value was there must read the old commands as ever.
TEST(Encoder, OnlyCommandsThatTakeAValueAndResultsThatHaveAMeasureGrow) {
  Encoder encoder;
  for (int code = 1; code <= 6; ++code) {
    const Command command{.code = static_cast<CommandCode>(code), .value = 1};
    EXPECT_EQ(EncodeToBytes(encoder, command).size(), MaxFrameBytes(3)) << code;
  }
  EXPECT_EQ(EncodeToBytes(encoder, Command{.code = CommandCode::kBlendProfile}).size(),
            MaxFrameBytes(7));
  for (int result = 0; result <= 9; ++result) {
    const Acknowledgement answer{.result = static_cast<CommandResult>(result), .measure = 1};
    EXPECT_EQ(EncodeToBytes(encoder, answer).size(), MaxFrameBytes(result < 5 ? 12 : 16)) << result;
  }
}

TEST(Encoder, EveryMessageFitsABufferOfExactlyItsSizeAndNoneSmaller) {
  for (const Message& message : OneOfEach()) {
    Encoder encoder;
    const std::size_t size = EncodeToBytes(encoder, message).size();
    ASSERT_GT(size, 0U);
    for (std::size_t room = 0; room < size; ++room) {
      Bytes buffer(room);
      Encoder small;
      const auto frame = small.Encode(message, buffer);
      ASSERT_FALSE(frame);
      EXPECT_EQ(frame.error(), Errc::kFull) << "type " << message.index() << " room " << room;
      EXPECT_EQ(small.sequence(), 0U);
    }
    Bytes buffer(size);
    EXPECT_TRUE(Encoder().Encode(message, buffer));
  }
}

TEST(Encoder, NothingIsWrittenBehindTheBuffer) {
  for (const Message& message : OneOfEach()) {
    std::array<std::byte, 64> memory;
    for (std::size_t room = 0; room < 40; ++room) {
      memory.fill(std::byte{0xA5});
      (void)Encoder().Encode(message, std::span(memory).first(room));
      for (std::size_t i = room; i < memory.size(); ++i) ASSERT_EQ(memory[i], std::byte{0xA5});
    }
  }
}

TEST(Encoder, NumbersFramesFromZeroAndSkipsZeroWhenTheyWrap) {
  Encoder encoder;
  for (int i = 0; i <= 0xFFFF; ++i) {
    ASSERT_EQ(encoder.sequence(), i);
    ASSERT_FALSE(EncodeToBytes(encoder, Command{}).empty());
  }
  EXPECT_EQ(encoder.sequence(), 1U);
}

TEST(Encoder, BlocksOf254BytesAreEncodedAsTheSpecificationSays) {
  // Counts around the one that makes 254 bytes before COBS, and around two such blocks; every byte
  // but some of the CRC is not zero.
  for (std::size_t count = 100; count <= kMaxChannels; ++count) {
    Pose pose{.rig_id = 0x01010101,
              .frame_seq = 0x01010101,
              .captured = Time(Duration(0x0101010101010101)),
              .age_us = 0x01010101,
              .state = ServiceState::kSearching};
    (void)pose.values.try_resize(count);
    for (std::uint16_t& v : pose.values) v = 0x0101;
    Encoder encoder;
    for (int i = 0; i < 0x0101; ++i) (void)EncodeToBytes(encoder, Command{});
    const Bytes payload = Bytes(21, std::byte{1}) + Bytes(1, static_cast<std::byte>(count)) +
                          Bytes(2 * count, std::byte{1});
    EXPECT_EQ(EncodeToBytes(encoder, pose), RawFrame(1, 0x10, 0x0101, payload)) << count;
  }
}

TEST(Encoder, ASixtyFourChannelPoseGoesSixtyTimesASecondThrough115200Baud) {
  constexpr std::size_t kBytesASecond = 115200 / 10;  // start bit, 8 data bits, stop bit
  static_assert(MaxFrameBytes(PosePayloadBytes(64)) * 60 < kBytesASecond);
  // and leaves room for a status each second
  static_assert(MaxFrameBytes(PosePayloadBytes(64)) * 60 + kStatusFrameBytes < kBytesASecond);
}

TEST(Encoder, DescriptionsFitASmallReceiver) { static_assert(kMaxDescriptionFrameBytes <= 64); }

TEST(Encoder, TheLargestMessagesFitTheDocumentedSizes) {
  Pose pose{.rig_id = 0xFFFFFFFF,
            .frame_seq = 0xFFFFFFFF,
            .captured = Time(Duration(-1)),
            .age_us = 0xFFFFFFFF,
            .state = ServiceState::kFault};
  (void)pose.values.try_resize(kMaxChannels);
  for (std::uint16_t& v : pose.values) v = 0xFFFF;
  std::array<std::byte, kMaxPoseFrameBytes> room;
  EXPECT_TRUE(Encoder().Encode(pose, room));

  ChannelDescription channel;
  channel.name = *ShortName::From("abcdefghijklmnopqrstuvwxyz01234");
  std::array<std::byte, kMaxDescriptionFrameBytes> description;
  EXPECT_EQ(Encoder().Encode(channel, description)->size(), kMaxDescriptionFrameBytes);
}

TEST(Encoder, NumbersThatAreNotFiniteAreRefusedAndTakeNoSequenceNumber) {
  for (float bad : {kNan, kInfinity, -kInfinity}) {
    std::array<std::byte, 128> out;
    Encoder encoder;
    const auto refused = {
        encoder.Encode(BoneDescription{.rest_cm = {0, bad, 0}}, out),
        encoder.Encode(ChannelDescription{.neutral = bad}, out),
        encoder.Encode(ChannelDescription{.min = bad}, out),
        encoder.Encode(ChannelDescription{.max = bad}, out),
        encoder.Encode(Command{.code = CommandCode::kBlendProfile, .value = bad}, out),
        encoder.Encode(Acknowledgement{.result = CommandResult::kMouthOpen, .measure = bad}, out)};
    for (const auto& frame : refused) {
      ASSERT_FALSE(frame);
      EXPECT_EQ(frame.error(), Errc::kInvalidArgument);
    }
    EXPECT_EQ(encoder.sequence(), 0U);
  }
}

TEST(Encoder, WhatADecoderWouldCallMalformedIsRefused) {
  std::array<std::byte, 128> out;
  Encoder encoder;
  EXPECT_FALSE(encoder.Encode(ChannelDescription{.neutral = 0, .min = 1, .max = 2}, out));
  EXPECT_FALSE(encoder.Encode(ChannelDescription{.neutral = 3, .min = 1, .max = 2}, out));
  EXPECT_FALSE(encoder.Encode(ChannelDescription{.bone = kMaxBones}, out));
  EXPECT_FALSE(encoder.Encode(ChannelDescription{.index = kMaxChannels}, out));
  EXPECT_FALSE(encoder.Encode(BoneDescription{.index = kMaxBones}, out));
  EXPECT_FALSE(encoder.Encode(RigHeader{.bones = kMaxBones + 1}, out));
  EXPECT_FALSE(encoder.Encode(RigHeader{.channels = kMaxChannels + 1}, out));
}

}  // namespace
}  // namespace facewire::wire
