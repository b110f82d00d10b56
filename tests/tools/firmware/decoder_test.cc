#include "core/wire/decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <span>
#include <vector>

#include "tests/core/wire/json.h"
#include "tests/core/wire/vectors.h"
#include "tests/tools/firmware/firmware.h"
#include "tests/tools/firmware/firmware_line.h"

namespace facewire::firmware {
namespace {

// Every stream of the vectors, one behind the other, with its beginning unseen.
Bytes AllStreams() {
  Bytes all;
  for (const wire::Vector& v : wire::AllVectors()) all = all + v.stream;
  return all;
}

TEST(FirmwareDecoder, ReadsEveryVectorAsTheDeviceDoes) {
  for (const wire::Vector& v : wire::AllVectors()) {
    EXPECT_EQ(ReadByFirmware(v.stream), ReadByDevice(v.stream)) << v.name;
  }
  EXPECT_EQ(ReadByFirmware(AllStreams()), ReadByDevice(AllStreams()));
}

TEST(FirmwareDecoder, ReadsTheMessagesThatAreForIt) {
  Line line;
  Bytes stream = line.Send(TwelveServos());
  stream = stream + line.Send(AllAt(1600));
  EXPECT_THAT(ReadByFirmware(stream).messages,
              testing::ElementsAre(wire::ToJson({.sequence = 0, .message = TwelveServos()}),
                                   wire::ToJson({.sequence = 1, .message = AllAt(1600)})));
}

TEST(FirmwareDecoder, ReadsDamagedStreamsAsTheDeviceDoes) {
  const Bytes sound = AllStreams();
  std::mt19937 random(7);
  const auto any = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  for (int round = 0; round < 300; ++round) {
    Bytes stream = sound;
    for (std::size_t faults = any(40); faults > 0; --faults) {
      const auto at = stream.begin() + static_cast<std::ptrdiff_t>(any(stream.size()));
      switch (any(4)) {
        case 0:
          *at ^= static_cast<std::byte>(1U << any(8));
          break;
        case 1:
          *at = static_cast<std::byte>(any(4) == 0 ? 0 : any(256));
          break;
        case 2:
          stream.erase(at);
          break;
        default:
          stream.insert(at, static_cast<std::byte>(any(256)));
      }
    }
    ASSERT_EQ(ReadByFirmware(stream), ReadByDevice(stream)) << "round " << round;
  }
}

TEST(FirmwareDecoder, ReadsPayloadsOfRandomBytesAsTheDeviceDoes) {
  std::mt19937 random(11);
  const auto any = [&](int below) { return std::uniform_int_distribution(0, below - 1)(random); };
  for (int round = 0; round < 20'000; ++round) {
    // Bytes that are likely in numbers from 2000 to 10000.
    Bytes payload(static_cast<std::size_t>(any(170)));
    for (std::size_t i = 0; i < payload.size(); ++i) {
      payload[i] = static_cast<std::byte>(i % 2 == 0 ? any(39) : any(256));
    }
    const bool setup = any(2) == 0;
    const std::size_t count_at = setup ? 16 : 5;
    if (payload.size() > count_at) payload[count_at] = static_cast<std::byte>(any(14));
    const Bytes frame = wire::RawFrame(1, setup ? 0x14 : 0x15, 0, payload);
    ASSERT_EQ(ReadByFirmware(frame), ReadByDevice(frame)) << "round " << round;
  }
}

TEST(FirmwareDecoder, CountsAnEndlessFrameOnceAndReadsTheNext) {
  Line line;
  Bytes stream = line.Send(TwelveServos()) + Bytes(200'000, std::byte{0xFF});
  stream = stream + line.Send(AllAt(1500));
  const Reading reading = ReadByFirmware(stream);
  EXPECT_EQ(reading.messages.size(), 2U);
  EXPECT_EQ(reading, ReadByDevice(stream));
}

// The frame that is complete but for its delimiter, which whatever comes next would bring.
TEST(FirmwareDecoder, GivesUpAFrameWhoseBytesStopComing) {
  Line line;
  const Bytes cut = line.Send(AllAt(1600));
  const Bytes next = line.Send(AllAt(1500));
  for (int ticks = 0; ticks < 10; ++ticks) {
    FwDecoder decoder;
    FwDecoderInit(&decoder);
    FwFrame frame;
    int sound = 0;
    for (const std::byte b : std::span(cut).first(cut.size() - 1)) {
      sound += FwDecoderTake(&decoder, std::to_integer<std::uint8_t>(b), &frame) ? 1 : 0;
    }
    for (int tick = 0; tick < ticks; ++tick) FwDecoderTick(&decoder);
    sound += FwDecoderTake(&decoder, 0, &frame) ? 1 : 0;
    for (const std::byte b : next) {
      sound += FwDecoderTake(&decoder, std::to_integer<std::uint8_t>(b), &frame) ? 1 : 0;
    }
    EXPECT_EQ(sound, ticks < FW_FRAME_GAP_TICKS ? 2 : 1) << ticks;
    EXPECT_EQ(FwDamaged(&decoder.stats), ticks < FW_FRAME_GAP_TICKS ? 0U : 1U) << ticks;
  }
}

TEST(FirmwareDecoder, GivesUpNothingBetweenFrames) {
  Line line;
  FwDecoder decoder;
  FwDecoderInit(&decoder);
  FwFrame frame;
  int sound = 0;
  for (int round = 0; round < 3; ++round) {
    for (const std::byte b : line.Send(AllAt(1500))) {
      sound += FwDecoderTake(&decoder, std::to_integer<std::uint8_t>(b), &frame) ? 1 : 0;
    }
    for (int tick = 0; tick < 50; ++tick) FwDecoderTick(&decoder);
  }
  EXPECT_EQ(sound, 3);
  EXPECT_EQ(FwDamaged(&decoder.stats), 0U);
}

TEST(FirmwareStatus, IsReadByTheDeviceAndIsItsShortestEncoding) {
  std::mt19937 random(3);
  for (int round = 0; round < 2000; ++round) {
    // Many zeros: each one ends a COBS block.
    const auto any = [&](std::uint32_t below) {
      return random() % 3 == 0 ? 0 : static_cast<std::uint32_t>(random() % below);
    };
    FwStatus status = {};
    status.setup_id = any(0xFFFFFFFF);
    status.state = static_cast<std::uint8_t>(any(8));
    status.reset_causes = static_cast<std::uint8_t>(any(16));
    status.supply_mv = static_cast<std::uint16_t>(any(6000));
    status.uptime_ms = any(0xFFFFFFFF);
    status.frames = any(1000);
    status.damaged = any(1000);
    status.lost = any(100'000);
    status.refused = any(300);
    status.count = static_cast<std::uint8_t>(any(FW_SERVOS + 1));
    for (std::size_t i = 0; i < status.count; ++i) {
      status.width[i] = static_cast<std::uint16_t>(random() % 4 == 0 ? 0 : 2000 + any(8001));
    }
    std::array<std::uint8_t, FW_STATUS_FRAME_BYTES> bytes;
    const std::size_t size = FwWriteStatus(&status, 0, bytes.data());
    ASSERT_LE(size, bytes.size());

    wire::Decoder decoder;
    auto stream = std::as_bytes(std::span(bytes)).first(size);
    const Bytes sent(stream.begin(), stream.end());
    const auto received = decoder.Next(stream);
    ASSERT_TRUE(received) << round;
    const auto& m = std::get<wire::ReceiverStatus>(received->message);
    EXPECT_EQ(m.setup_id, status.setup_id);
    EXPECT_EQ(static_cast<int>(m.state), status.state);
    EXPECT_EQ(m.capacity, FW_SERVOS);
    EXPECT_EQ(m.reset_causes, status.reset_causes);
    EXPECT_EQ(m.supply_mv, status.supply_mv);
    EXPECT_EQ(m.uptime_ms, status.uptime_ms);
    EXPECT_EQ(m.frames, status.frames);
    EXPECT_EQ(m.damaged, status.damaged);
    EXPECT_EQ(m.lost, status.lost);
    EXPECT_EQ(m.refused, status.refused);
    EXPECT_THAT(std::vector(m.quarter_us.begin(), m.quarter_us.end()),
                testing::ElementsAreArray(status.width, status.count));
    EXPECT_EQ(Line().Send(m), sent);
  }
}

}  // namespace
}  // namespace facewire::firmware
