#include "core/wire/osc_host/pose_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/wire/osc/reader.h"
#include "core/wire/osc/slip.h"
#include "core/wire/osc_host/address.h"
#include "core/wire/osc_host/command.h"
#include "core/wire/pose.h"

namespace facewire::wire::osc_host {
namespace {

constexpr std::size_t kPlenty = 100'000;

Rig RigOf(std::size_t channels) {
  Rig rig;
  for (std::size_t i = 0; i < channels; ++i) {
    Channel channel;
    channel.name = *ShortName::From("channel" + std::to_string(i));
    channel.min = -1;
    channel.max = 3;
    EXPECT_TRUE(rig.channels.try_push(channel));
  }
  return rig;
}

struct Context {
  explicit Context(std::size_t channels, std::size_t bytes_a_pose = kPlenty)
      : rig(RigOf(channels)), room(bytes_a_pose), values(rig.NeutralPose()) {
    writer.SetRig(rig);
  }
  // One pose to the receiver; the order of the values that it got.
  std::vector<std::string> Send(std::size_t packets_taken = kPlenty) {
    pose = MakePose(rig, 1, values, ServiceState::kTracking, Time{});
    pose.frame_seq = ++seq;
    std::vector<std::string> order;
    bytes = 0;
    begun = writer.Begin(pose, room);
    if (!begun) return order;
    for (;; --packets_taken) {
      const auto frame = writer.Next(out);
      if (!frame) {
        EXPECT_EQ(frame.error(), Errc::kEnd);
        return order;
      }
      if (packets_taken == 0) return order;  // the line is full
      bytes += frame->size();
      Receive(*frame, order);
    }
  }
  void Receive(std::span<const std::byte> line, std::vector<std::string>& order) {
    const auto packet = slip.Next(line);
    auto reader = osc::Reader::Of(packet.value());
    ASSERT_TRUE(reader);
    EXPECT_LE(packet->size(), kMaxPacketBytes);
    while (const auto message = reader->Next()) {
      EXPECT_NE(whole, seq) << "nothing follows /facewire/pose";
      if (message->address == "/facewire/pose") {
        EXPECT_EQ(message->types, "iif");
        whole = static_cast<std::uint32_t>(*message->Number());
      } else {
        order.emplace_back(message->address);
        received[order.back()] = *message->Number();
      }
    }
  }
  float Received(std::size_t channel) const {
    const auto found = received.find("/face/channel" + std::to_string(channel));
    return found == received.end() ? NAN : found->second;
  }
  float Sent(std::size_t channel) const { return Dequantise(pose.values[channel], -1, 3); }

  Rig rig;
  std::size_t room;
  RigPose values;
  PoseWriter writer;
  Pose pose;
  bool begun = false;
  std::uint32_t seq = 0;
  std::uint32_t whole = 0;  // the last pose that was said to be complete
  std::size_t bytes = 0;    // of the last pose
  std::map<std::string, float> received;
  std::array<std::byte, osc::MaxSlipBytes(kMaxPacketBytes)> out{};
  std::array<std::byte, kMaxPacketBytes> memory{};
  osc::SlipDecoder slip{memory};
};

TEST(OscPoseWriter, TheFirstPoseHasEveryValueAndTheNextOnlySomeInTurn) {
  Context c(50);
  EXPECT_EQ(c.Send().size(), 50U);
  EXPECT_EQ(c.whole, 1U);
  EXPECT_EQ(c.Send(), (std::vector<std::string>{"/face/channel4", "/face/channel5",
                                                "/face/channel6", "/face/channel7"}));
  for (int i = 0; i < 11; ++i) c.Send();
  EXPECT_EQ(c.Send().back(), "/face/channel5") << "and round again";
}

TEST(OscPoseWriter, WithRoomTheReceiverHasEveryValueOfEveryPose) {
  Context c(kMaxChannels);
  std::mt19937 dice(1);
  std::uniform_real_distribution<float> any(-1, 3);
  for (int i = 0; i < 50; ++i) {
    for (std::size_t k = 0; k < kMaxChannels; ++k) {
      if (dice() % 3 > 0) c.values.values[k] = any(dice);
    }
    c.Send();
    EXPECT_EQ(c.whole, c.seq);
    for (std::size_t k = 0; k < kMaxChannels; ++k) EXPECT_EQ(c.Received(k), c.Sent(k));
  }
}

TEST(OscPoseWriter, WhatChangedTheMostGoesFirst) {
  Context c(50);
  c.Send();
  c.values.values[40] = 0.1F;
  c.values.values[30] = 3;
  c.values.values[20] = -1;
  const auto order = c.Send();
  ASSERT_EQ(order.size(), PoseWriter::kInTurn + 3);
  EXPECT_EQ(order[4], "/face/channel30");
  EXPECT_EQ(order[5], "/face/channel20");
  EXPECT_EQ(order[6], "/face/channel40");
}

TEST(OscPoseWriter, APoseTakesItsRoomAndAtMostAMessageMore) {
  for (const std::size_t room : {128U, 129U, 300U, 480U, 1000U, 4000U}) {
    Context c(kMaxChannels, room);
    const auto order = c.Send();
    EXPECT_EQ(c.whole, 1U) << room;
    EXPECT_GE(order.size(), 1U) << room;
    EXPECT_LE(c.bytes, room + 100) << room;
    EXPECT_GE(c.bytes + 100, room) << "and uses it";
  }
}

TEST(OscPoseWriter, WithoutRoomThereIsNoPose) {
  Context c(10, PoseWriter::kLeastRoom - 1);
  EXPECT_TRUE(c.Send().empty());
  EXPECT_FALSE(c.begun);
}

TEST(OscPoseWriter, NoValueStarvesWhenOthersMoveMore) {
  Context c(60, 480);
  std::mt19937 dice(2);
  int poses = 0;
  for (; poses < 100 && c.received.size() < 60; ++poses) {
    for (std::size_t k = 0; k < 30; ++k) c.values.values[k] = dice() % 2 == 0 ? -1.0F : 3.0F;
    c.Send();
  }
  EXPECT_LE(poses, 60 / PoseWriter::kInTurn + 1);
}

TEST(OscPoseWriter, WhatTheLineDidNotTakeIsSentAgain) {
  Context c(50);
  c.Send();
  for (std::size_t k = 0; k < 50; ++k) c.values.values[k] = 2;
  const auto taken = c.Send(1);
  EXPECT_LT(taken.size(), 10U);
  EXPECT_EQ(c.whole, 1U) << "that pose is not complete";
  c.Send();
  EXPECT_EQ(c.whole, 3U);
  for (std::size_t k = 0; k < 50; ++k) EXPECT_EQ(c.Received(k), c.Sent(k));
}

TEST(OscPoseWriter, AReceiverThatForgotGetsEverything) {
  Context c(50);
  c.Send();
  c.writer.Forget();
  EXPECT_EQ(c.Send().size(), 50U);
}

TEST(OscPoseWriter, ARigWithoutChannelsStillSaysThatItLives) {
  Context c(0);
  EXPECT_TRUE(c.Send().empty());
  EXPECT_EQ(c.whole, 1U);
}

TEST(OscPoseWriter, WithoutARigThereIsNoPose) {
  PoseWriter writer;
  EXPECT_FALSE(writer.Begin(Pose{}, kPlenty));
}

}  // namespace
}  // namespace facewire::wire::osc_host
