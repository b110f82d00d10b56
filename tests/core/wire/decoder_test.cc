#include "core/wire/decoder.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "core/wire/encoder.h"
#include "tests/core/wire/json.h"
#include "tests/core/wire/raw_frame.h"
#include "tests/core/wire/vectors.h"

namespace facewire::wire {
namespace {

// A device's line that one message after the other goes through.
struct Context {
  Encoder encoder;
  Decoder decoder;
  std::vector<Received> received;

  Bytes Send(const Message& message) {
    std::array<std::byte, kMaxFrameBytes> buffer;
    const auto frame = encoder.Encode(message, buffer).value();
    return {frame.begin(), frame.end()};
  }
  Bytes Ping(int id) { return Send(Command{.id = static_cast<std::uint16_t>(id)}); }
  void Push(std::span<const std::byte> bytes) {
    for (;;) {
      const auto next = decoder.Next(bytes);
      if (next) received.push_back(*next);
      if (!next && next.error() == Errc::kNotReady) return;
    }
  }
  // The ids of the commands that arrived.
  std::vector<int> Ids() const {
    std::vector<int> ids;
    for (const Received& r : received) {
      if (const auto* command = std::get_if<Command>(&r.message)) ids.push_back(command->id);
    }
    return ids;
  }
};

Pose SomePose() {
  Pose pose{.rig_id = 0x00FF00FF, .frame_seq = 258, .captured = Time(Duration(1'000'000))};
  (void)pose.values.try_resize(40);
  for (std::size_t i = 0; i < 40; ++i) pose.values[i] = static_cast<std::uint16_t>(i * 1600);
  return pose;
}

TEST(Decoder, EveryStreamOfTheVectorsIsReadAlikeHoweverItIsCutInTwo) {
  for (const Vector& v : AllVectors()) {
    Context whole;
    whole.Push(v.stream);
    for (std::size_t i = 0; i <= v.stream.size(); ++i) {
      Context split;
      split.Push(std::span(v.stream).first(i));
      split.Push(std::span(v.stream).subspan(i));
      ASSERT_EQ(ToJson(split.decoder.stats()), ToJson(whole.decoder.stats())) << v.name << i;
      ASSERT_EQ(split.received.size(), whole.received.size()) << v.name << i;
      for (std::size_t m = 0; m < whole.received.size(); ++m) {
        ASSERT_EQ(ToJson(split.received[m]), ToJson(whole.received[m])) << v.name << i;
      }
    }
  }
}

TEST(Decoder, ByteByByteIsEnough) {
  Context context;
  const Bytes stream = context.Ping(1) + context.Send(SomePose()) + context.Ping(2);
  for (std::byte b : stream) context.Push(std::span(&b, 1));
  EXPECT_EQ(context.received.size(), 3U);
  EXPECT_EQ(context.decoder.stats().Damaged(), 0U);
}

TEST(Decoder, AWrongByteAnywhereIsDetectedAndTheNextFrameIsDelivered) {
  Context maker;
  const Bytes before = maker.Ping(1);
  const Bytes pose = maker.Send(SomePose());
  const Bytes after = maker.Ping(2);
  for (std::size_t at = 0; at < pose.size(); ++at) {
    for (int wrong = 0; wrong < 256; ++wrong) {
      Bytes damaged = pose;
      if (damaged[at] == static_cast<std::byte>(wrong)) continue;
      damaged[at] = static_cast<std::byte>(wrong);
      Context context;
      context.Push(before + damaged + after);
      // A wrong delimiter at either end is made good by the neighbour's.
      const bool harmless = (at == 0 || at + 1 == pose.size()) && context.received.size() == 3;
      if (harmless) continue;
      ASSERT_EQ(context.Ids(), (std::vector<int>{1, 2})) << "byte " << at << " as " << wrong;
      ASSERT_EQ(context.received.size(), 2U);
      ASSERT_GE(context.decoder.stats().Damaged(), 1U);
      ASSERT_EQ(context.decoder.stats().lost, 1U);
      ASSERT_EQ(context.decoder.stats().resyncs, 1U);
    }
  }
}

TEST(Decoder, MissingBytesAnywhereLoseNoMoreThanTheirFrame) {
  Context maker;
  const Bytes before = maker.Ping(1);
  const Bytes pose = maker.Send(SomePose());
  const Bytes after = maker.Ping(2);
  for (std::size_t from = 0; from < pose.size(); ++from) {
    for (std::size_t to = from + 1; to <= pose.size(); ++to) {
      const std::span<const std::byte> all(pose);
      Context context;
      context.Push(before);
      context.Push(all.first(from));
      context.Push(all.subspan(to));
      context.Push(after);
      ASSERT_EQ(context.Ids(), (std::vector<int>{1, 2})) << from << ".." << to;
      // Only a delimiter that a neighbour has too can be missed without harm.
      const bool harmless = to - from == 1 && (from == 0 || to == pose.size());
      ASSERT_EQ(context.received.size(), harmless ? 3U : 2U) << from << ".." << to;
      ASSERT_EQ(context.decoder.stats().lost, harmless ? 0U : 1U) << from << ".." << to;
    }
  }
}

TEST(Decoder, EveryKindOfDamageHasItsOwnErrorAndCount) {
  const auto first_error = [](Context& context, const Bytes& bytes) {
    std::span<const std::byte> rest(bytes);
    const auto next = context.decoder.Next(rest);
    return next ? Errc{} : next.error();
  };
  const Bytes ping = MakeBytes({1, 0, 1});
  const Bytes zero = MakeBytes({0});
  Context context;
  Bytes wrong = RawFrame(1, 0x80, 1, ping);
  wrong[wrong.size() - 2] ^= std::byte{1};
  EXPECT_EQ(first_error(context, wrong), Errc::kCorrupt);
  EXPECT_EQ(context.decoder.stats().crc_errors, 1U);
  EXPECT_EQ(first_error(context, MakeBytes({9, 1, 2, 0})), Errc::kCorrupt);
  EXPECT_EQ(context.decoder.stats().cobs_errors, 1U);
  EXPECT_EQ(first_error(context, MakeBytes({2, 1, 0})), Errc::kTruncated);
  EXPECT_EQ(context.decoder.stats().truncated, 1U);
  EXPECT_EQ(first_error(context, Bytes(1100, std::byte{1}) + zero), Errc::kFull);
  EXPECT_EQ(context.decoder.stats().overflows, 1U);
  EXPECT_EQ(first_error(context, RawFrame(7, 0x80, 1, ping)), Errc::kVersion);
  EXPECT_EQ(context.decoder.stats().versions, 1U);
  EXPECT_EQ(first_error(context, RawFrame(1, 0x33, 1, ping)), Errc::kUnsupported);
  EXPECT_EQ(context.decoder.stats().unknown, 1U);
  EXPECT_EQ(first_error(context, RawFrame(1, 0x80, 2, {})), Errc::kInvalidArgument);
  EXPECT_EQ(context.decoder.stats().malformed, 1U);
  EXPECT_EQ(first_error(context, {}), Errc::kNotReady);
  EXPECT_EQ(context.decoder.stats().Damaged(), 4U);
  EXPECT_EQ(context.decoder.stats().frames, 0U);
}

TEST(Decoder, AFrameThatJustFitsIsReadAndOneByteMoreIsNot) {
  for (std::size_t extra : {0U, 1U}) {
    Context context;
    const Bytes payload = MakeBytes({1, 0, 1}) + Bytes(kMaxPayloadBytes - 3 + extra, std::byte{7});
    context.Push(RawFrame(1, 0x80, 0, payload) + RawFrame(1, 0x80, 1, MakeBytes({2, 0, 1})));
    EXPECT_EQ(context.Ids(), extra == 0 ? (std::vector<int>{1, 2}) : (std::vector<int>{2}));
    EXPECT_EQ(context.decoder.stats().overflows, extra);
  }
}

TEST(Decoder, AnEndlessStreamWithoutDelimitersIsSurvived) {
  Context context;
  const Bytes before = context.Ping(1);
  context.Push(before + Bytes(1'000'000, std::byte{0xFF}));
  context.Push(context.Ping(2));
  EXPECT_EQ(context.Ids(), (std::vector<int>{1, 2}));
  EXPECT_EQ(context.decoder.stats().overflows, 1U);
}

TEST(Decoder, RandomBytesNeverHurtAndTheNextFrameIsAlwaysDelivered) {
  std::mt19937 random(20240229);
  const auto any = [&](int below) { return std::uniform_int_distribution(0, below - 1)(random); };
  for (int round = 0; round < 20'000; ++round) {
    Context context;
    Bytes noise(static_cast<std::size_t>(any(any(10) == 0 ? 3000 : 60)));
    const int zeros = any(2) == 0 ? 20 : 256;  // more or fewer delimiters
    for (std::byte& b : noise) {
      b = static_cast<std::byte>(any(zeros) == 0 ? 0 : any(256));
    }
    context.Push(noise);
    ASSERT_TRUE(context.received.empty()) << "round " << round;
    context.Push(context.Ping(1));
    ASSERT_EQ(context.Ids(), std::vector<int>{1}) << "round " << round;
  }
}

TEST(Decoder, PayloadsOfRandomBytesAreEitherDeliveredOrCountedAsMalformed) {
  std::mt19937 random(42);
  const auto any = [&](int below) { return std::uniform_int_distribution(0, below - 1)(random); };
  constexpr std::array kTypes = {0x01, 0x02, 0x03, 0x10, 0x11, 0x12,
                                 0x13, 0x14, 0x15, 0x16, 0x80, 0x81};
  for (int round = 0; round < 20'000; ++round) {
    Bytes payload(static_cast<std::size_t>(any(80)));
    for (std::byte& b : payload) b = static_cast<std::byte>(any(any(2) == 0 ? 256 : 4));
    Context context;
    context.Push(RawFrame(1, kTypes[static_cast<std::size_t>(any(kTypes.size()))], 0, payload));
    ASSERT_EQ(context.decoder.stats().frames + context.decoder.stats().malformed, 1U);
    ASSERT_EQ(context.received.size(), context.decoder.stats().frames);
    // What was delivered can be sent on.
    for (const Received& r : context.received) {
      std::array<std::byte, kMaxFrameBytes> out;
      EXPECT_TRUE(Encoder().Encode(r.message, out)) << ToJson(r);
    }
  }
}

TEST(Decoder, EverythingThatIsSentArrivesAsItWas) {
  for (const Vector& v : AllVectors()) {
    Context once;
    once.Push(v.stream);
    for (const Received& r : once.received) {
      Context again;
      again.Push(again.Send(r.message));
      ASSERT_EQ(again.received.size(), 1U) << v.name;
      Received renumbered = r;
      renumbered.sequence = 0;
      EXPECT_EQ(ToJson(again.received[0]), ToJson(renumbered)) << v.name;
    }
  }
}

}  // namespace
}  // namespace facewire::wire
